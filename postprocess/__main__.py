# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run as `python3 -m postprocess DIRECTORY` or `python3 postprocess DIRECTORY`."""

import sys
from pathlib import Path

if not __package__:  # started by the name of the folder
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

try:
    from postprocess.command_line import main

    status = main()
except ModuleNotFoundError as error:
    sys.exit(
        f"error: the Python package '{error.name}' is missing for {sys.executable}. "
        "On Debian: apt-get install python3-numpy python3-h5py python3-matplotlib python3-pandas, "
        "then use /usr/bin/python3."
    )

sys.exit(status)
