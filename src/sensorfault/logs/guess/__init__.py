"""Guesses what the columns of an unknown log are."""

from collections.abc import Callable

from sensorfault.core.extras import require
from sensorfault.logs.place import Where
from sensorfault.logs.vehicle import VehicleFile


def guess(path: Where, tell: Callable[[float], None] = lambda share: None, rate_hz: float | None = None) -> VehicleFile:
    """Describe a log from its names and values.

    Args:
        path: a file, a folder, or several files of one drive.
        tell: is called with the share of a large file that has been read, 0 to 1.
        rate_hz: rows a second of tables that have no clock.

    Raises:
        LogError: nothing can be read, no file has a time column, or the files are logs of different drives.
        MissingLibrary: polars is not installed.
    """
    require(f"{path}: reading it", "polars")
    from sensorfault.logs.guess.vehicle import guess_files

    return guess_files(path, tell, rate_hz)
