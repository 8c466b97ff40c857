"""Read a log: the public function, which can be imported where no reader is installed."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sensorfault.core.expect import expect, wrong
from sensorfault.core.extras import require
from sensorfault.logs.place import Where
from sensorfault.logs.resample import Resample
from sensorfault.logs.table import Log
from sensorfault.logs.vehicle import VehicleFile

if TYPE_CHECKING:
    from sensorfault.logs.memory import Table

_READABLE = "a file, a folder, a list of files, or a table: a Polars or pandas DataFrame, or a dict of columns"


def read(
    path: "Where | Table",
    vehicle: str | Path | VehicleFile | None = None,
    resample: Resample = "hold",
    tell: Callable[[float], None] = lambda share: None,
    model: VehicleFile | None = None,
    rate_hz: float | None = None,
) -> Log:
    """Read a log: files of a drive, or a table that is in memory already.

    A damaged file is read as far as it can be: `Log.damage` says where that ends.

    Args:
        path: a file, a folder, or several files of one drive; or a table: a Polars or pandas DataFrame, or a dict
            of columns by name. A table's columns are named, and its time column found, as those of a CSV file.
        vehicle: what the columns are, and their units: a vehicle.toml, or what was read from one. None:
            `NAME.vehicle.toml` or `vehicle.toml` beside the log, if the log has the columns that it names; else what
            `model` says; else, and of a table, the columns are guessed, and a note says so.
        resample: how slower files come to the ticks of the fastest. "hold": a measurement is put on the first tick
            at or after its own time and the other ticks stay empty. "linear": drawn between measurements, which looks
            into the future and smooths faults over; for plots, and for papers that ask for it.
        tell: is called with the share of a large file that has been read, 0 to 1.
        model: what a fitted model knows of the columns, its `description`; a vehicle file must agree with it.
        rate_hz: rows a second of tables that have no clock.

    Returns:
        The log on one clock: T rows, C channels, values in SI, NaN where nothing arrived.

    Raises:
        LogError: the log cannot be used; one sentence says why.
        MissingLibrary: polars, which reads and joins tables, is not installed.
        TypeError: `path` or `vehicle` is of a type that is none of these.
    """
    expect(vehicle, (str, Path, VehicleFile, type(None)), "read: vehicle", "the path of a vehicle.toml")
    require(f"{path}: reading it" if isinstance(path, str | Path) else "reading a log", "polars")
    from sensorfault.logs.memory import is_table, source_of
    from sensorfault.logs.reading import read_files, read_table

    if is_table(path):
        return read_table(source_of(path), vehicle or model, resample, rate_hz)
    return read_files(_where(path), vehicle, resample, tell, model, rate_hz)


def _where(path: object) -> Where:
    """The same, if it names files.

    Raises:
        TypeError: it is neither a path nor several.
    """
    if isinstance(path, str | Path):
        return path
    if isinstance(path, Log):
        raise wrong(path, "read: path", f"{_READABLE}; a Log has been read already")
    if not isinstance(path, Sequence) or not all(isinstance(one, str | Path) for one in path):
        raise wrong(path, "read: path", _READABLE)
    return path
