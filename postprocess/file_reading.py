# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading files that another program may be writing, or has left half-written; what is wrong comes as ResultsError."""

import os
import stat
import time
from dataclasses import dataclass

import h5py

from postprocess.errors import ResultsError, Unreadable

PAUSE = 0.02  # seconds between two tries; the program needs some milliseconds for an output
# A file that has not changed for so long (seconds) is not being written: waiting would not help.
RECENT = 1.0
# For so long (seconds) a file that is being written is tried again: if it cannot be read, and if it can but may change
# under the reader.
PATIENCE = 3.0
PATIENCE_WHEN_READABLE = 0.25

DAMAGED = "it is damaged, or was not written to its end"
SIGNATURE = b"\x89HDF\r\n\x1a\n"


def _can_ignore_locks():
    """Whether h5py and the HDF5 library below it know how to."""
    library = h5py.version.hdf5_version_tuple
    return h5py.version.version_tuple[:2] >= (3, 5) and (library >= (1, 12, 1) or (1, 10, 7) <= library < (1, 11))


# The program that writes the results does not lock them either.
WITHOUT_LOCKS = {"locking": False} if _can_ignore_locks() else {}


@dataclass(frozen=True)
class State:
    """What shows that a file has changed."""

    number: int
    size: int
    changed: int  # nanoseconds

    def is_recent(self):
        return abs(time.time() - self.changed * 1e-9) < RECENT


def state(path, name=None):
    """The present State of a file; Unreadable if there is none that could be read."""
    try:
        found = os.stat(path)
    except (OSError, ValueError) as error:
        raise Unreadable(name or path, _reason(path, error)) from error
    if not stat.S_ISREG(found.st_mode):
        raise Unreadable(name or path, "it is a directory" if stat.S_ISDIR(found.st_mode) else "it is not a file")
    return State(found.st_ino, found.st_size, found.st_mtime_ns)


def read_text(path):
    """The text of a file; bytes that are no text are replaced."""
    state(path)
    try:
        with open(path, encoding="utf-8", errors="replace", newline="") as file:
            return file.read()
    except OSError as error:
        raise Unreadable(path, _reason(path, error)) from error


def read_hdf5(path, extract, name=None, is_complete=lambda value: True):
    """
    What `extract` makes of the open HDF5 file `path`, called `name` in messages. Raises the ResultsError of `extract`,
    and Unreadable for everything else.

    The index of an HDF5 file is changed in place, so that somebody who reads while another program writes may find any
    nonsense. A result counts if nobody was writing from before the file was opened until it was read; otherwise, and if
    there is none, or one of which `is_complete` is false, the file is tried again as long as it keeps changing. After
    some seconds a result is better than none.
    """
    begin = time.monotonic()
    while True:
        before = state(path, name)
        was_closed = _is_closed(path, before.size)
        value, failure = _try(path, extract, name)
        is_good = failure is None and is_complete(value)
        is_unchanged = state(path, name) == before
        if is_good and is_unchanged and was_closed:
            return value
        waited = time.monotonic() - begin
        if waited > (PATIENCE_WHEN_READABLE if is_good else PATIENCE) or (is_unchanged and not before.is_recent()):
            break
        time.sleep(PAUSE)
    if failure is not None:
        raise failure
    return value


def _try(path, extract, name):
    """What `extract` gives and None, or None and a ResultsError."""
    try:
        with h5py.File(path, "r", **WITHOUT_LOCKS) as file:
            return extract(file), None
    except ResultsError as error:
        return None, error
    except Exception as error:  # h5py meets damage with errors of almost any type
        failure = Unreadable(name or path, _reason(path, error))
        failure.__cause__ = error
        return None, failure


def _is_closed(path, size):
    """
    False while a program has the file open for writing: what HDF5 notes of its size when it closes a file differs from
    the size then, since space has been reserved, or values have been added behind the end. Also true of what is no HDF5
    file.
    """
    try:
        with open(path, "rb") as file:
            head = file.read(64)
    except OSError:
        return True
    if len(head) < 64 or not head.startswith(SIGNATURE):
        return True
    place = {0: 40, 1: 44}.get(head[8], 28)  # of the end of the file, by the version of the superblock
    return int.from_bytes(head[place : place + 8], "little") == size


def _reason(path, error):
    """Why a file cannot be read, as a clause."""
    if isinstance(error, FileNotFoundError):
        return "it is missing"
    if isinstance(error, PermissionError):
        return "its permissions do not allow it"
    if isinstance(error, BlockingIOError) or "unable to lock" in str(error):
        return "another program has locked it"
    try:
        if os.path.getsize(path) == 0:
            return "it is empty"
    except (OSError, ValueError) as failure:
        return str(getattr(failure, "strerror", failure))
    return DAMAGED
