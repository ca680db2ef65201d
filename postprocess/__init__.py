# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of a Gemmule run: time series, snapshots of the membrane, the mesh."""
