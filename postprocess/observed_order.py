# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orders of convergence from runs alone, without an exact solution."""

import numpy as np

LARGEST_ORDER = 20.0


def observed_order(sizes, coarse_difference, fine_difference):
    """
    The p for which results q(h) = q(0) + C h^p at three sizes h1 > h2 > h3 differ as these do: |q(h1) - q(h2)| and
    |q(h2) - q(h3)|, that is (h1^p - h2^p) / (h2^p - h3^p) is their ratio. nan if one of them vanishes (round-off
    shows no order) or no p up to 20 in size does it.

    A comparison with the finest run instead would take it as exact, which makes orders look better than they are.
    """
    if not (coarse_difference > 0 and fine_difference > 0):
        return float("nan")
    ratio = np.log(coarse_difference / fine_difference)
    low, high = -LARGEST_ORDER, LARGEST_ORDER
    if not ratio_of_differences(sizes, low) <= ratio <= ratio_of_differences(sizes, high):
        return float("nan")
    for _ in range(100):  # the ratio grows with p
        middle = (low + high) / 2
        if ratio_of_differences(sizes, middle) < ratio:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def ratio_of_differences(sizes, order):
    """log of (h1^p - h2^p) / (h2^p - h3^p)."""
    coarse, fine = np.log(sizes[0] / sizes[1]), np.log(sizes[1] / sizes[2])
    if abs(order) * max(coarse, fine) < 1e-8:
        return np.log(coarse / fine)
    # (h1/h2)^p - 1 over 1 - (h3/h2)^p
    return np.log(np.expm1(order * coarse) / -np.expm1(-order * fine))


def orders(sizes, successive_differences):
    """One per run: nan for the first and the last, else from it and its two neighbours."""
    result = np.full(len(sizes), np.nan)
    for i in range(1, len(sizes) - 1):
        result[i] = observed_order(sizes[i - 1 : i + 2], successive_differences[i - 1], successive_differences[i])
    return result
