# SPDX-License-Identifier: LGPL-2.1-or-later
"""What can be wrong with results."""


class ResultsError(Exception):
    """Results that are missing or cannot be read; the message is for the user."""


class Unreadable(ResultsError):
    """A file, or a part of one, that cannot be read; `reason` is a clause such as 'it is empty'."""

    def __init__(self, name, reason):
        super().__init__(f"{name} cannot be read: {reason}")
        self.reason = reason
