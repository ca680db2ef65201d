# SPDX-License-Identifier: LGPL-2.1-or-later
"""All pictures of a run: what can be drawn is drawn, and what cannot is told."""

from pathlib import Path

from postprocess import matplotlib_loading
from postprocess.errors import ResultsError

MOST_NAMES = 5


class Pictures:
    """
    Draws the pictures of some Results into a folder. Afterwards `failed` says which could not be drawn (name ->
    reason).
    """

    def __init__(self, results, folder, times=None):
        self.results, self.folder, self.times = results, Path(folder), times
        self.failed = {}

    def draw(self):
        """Draw one after the other; the paths of those that could be drawn, as they get ready."""
        matplotlib_loading.load()
        from postprocess import mesh, snapshots, style, time_series

        for name, figure in (
            ("timeseries.png", lambda: time_series.figure(self.results.statistics())),
            ("snapshots.png", lambda: snapshots.figure(self.results, self.times)),
            ("mesh.png", lambda: mesh.figure(self.results, self.times)),
        ):
            with style.applied():
                path = self._try(name, figure, style.save)
            if path:
                yield path

    def _try(self, name, make, save):
        """The path of the saved picture, or None."""
        try:
            figure = make()
        except ResultsError as error:
            self.failed[name] = str(error)
            return None
        except Exception as error:  # one picture must not cost the others, whatever it is
            self.failed[name] = f"it cannot be drawn of these results, {type(error).__name__}: {error}"
            return None
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            return save(figure, self.folder / name)
        except OSError as error:
            self.failed[name] = (
                f"it cannot be saved in '{self.folder}': {error.strerror or error}; "
                "make room there, or give another directory with --output"
            )
        except Exception as error:
            self.failed[name] = f"it cannot be drawn of these results, {type(error).__name__}: {error}"
        return None

    def note(self):
        """One sentence about all that is not drawn; empty if everything is."""
        parts = [f"no {', no '.join(names)} ({reason})" for reason, names in by_reason(self.failed).items()]
        left_out = [f"{enumeration(names)} ({reason})" for reason, names in by_reason(self.results.unreadable).items()]
        if left_out:
            parts.append("left out: " + ", ".join(left_out))
        return "; ".join(parts)


def by_reason(reasons):
    """Reason -> names, of name -> reason."""
    result = {}
    for name, reason in reasons.items():
        result.setdefault(reason, []).append(name)
    return result


def enumeration(names):
    """The first of the names, and how many more there are."""
    more = len(names) - MOST_NAMES
    return ", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")
