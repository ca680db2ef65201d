# SPDX-License-Identifier: LGPL-2.1-or-later
"""Importing matplotlib as it is delivered."""

import os
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

SETTINGS = Path(__file__).resolve().parent / "settings"


def load():
    """
    Import matplotlib without the user's settings, unless it has been imported. Already at the import a matplotlibrc, or
    an environment variable, that is damaged or asks for what is not installed would end the program. Raises
    ModuleNotFoundError if matplotlib is missing.
    """
    if "matplotlib" not in sys.modules:
        with _working_directory(SETTINGS), _environment("MPLBACKEND", "Agg"):  # a matplotlibrc there comes first
            import matplotlib  # noqa: F401


@contextmanager
def _working_directory(directory):
    try:
        before = os.open(".", getattr(os, "O_PATH", os.O_RDONLY))
    except OSError:  # there is no way back
        yield
        return
    try:
        with suppress(OSError):
            os.chdir(directory)
        yield
    finally:
        with suppress(OSError):
            os.fchdir(before)
        os.close(before)


@contextmanager
def _environment(name, value):
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
