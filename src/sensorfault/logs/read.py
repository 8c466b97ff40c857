"""Read a log: the public function, which can be imported where no reader is installed."""

from collections.abc import Callable
from pathlib import Path

from sensorfault.core.extras import require
from sensorfault.logs.place import Where
from sensorfault.logs.resample import Resample
from sensorfault.logs.table import Log
from sensorfault.logs.vehicle import VehicleFile


def read(
    path: Where,
    vehicle: str | Path | VehicleFile | None = None,
    resample: Resample = "hold",
    tell: Callable[[float], None] = lambda share: None,
) -> Log:
    """Read a log.

    A damaged file is read as far as it can be: `Log.damage` says where that ends.

    Args:
        path: a file, a folder, or several files of one drive.
        vehicle: what the columns are: a vehicle.toml, or what was read from one. None: `NAME.vehicle.toml` or
            `vehicle.toml` beside the log; where there is none the columns are guessed, and a note says so.
        resample: how slower files come to the ticks of the fastest. "hold": a measurement is put on the first tick
            at or after its own time and the other ticks stay empty. "linear": drawn between measurements, which looks
            into the future and smooths faults over; for plots, and for papers that ask for it.
        tell: is called with the share of a large file that has been read, 0 to 1.

    Returns:
        The log in SI units on one clock.

    Raises:
        LogError: the log cannot be used; one sentence says why.
        MissingLibrary: polars, which reads and joins tables, is not installed.
    """
    require(f"{path}: reading it", "polars")
    from sensorfault.logs.reading import read_files

    return read_files(path, vehicle, resample, tell)
