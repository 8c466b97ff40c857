"""Reads a long log part by part, in memory that does not grow with the file."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from sensorfault.logs.describing import describe
from sensorfault.logs.joining import Joining
from sensorfault.logs.place import files_of, pair_files
from sensorfault.logs.readers.beginning import is_long
from sensorfault.logs.readers.formats import format_of, known_format, read_tables
from sensorfault.logs.readers.registry import registered
from sensorfault.logs.readers.source import Ask
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile


def file_of_parts(path: Path) -> Path | None:
    """The file of a log that `read_parts` can read: itself, or the only one in a folder; None if there is none."""
    files = files_of(path)
    form = format_of(files[0]) if len(files) == 1 else None
    return files[0] if form is not None and form.parts else None


def is_long_log(path: Path) -> bool:
    """Whether a log is better read part by part, and can be."""
    file = file_of_parts(path)
    return file is not None and is_long(file)


@np.errstate(over="ignore", invalid="ignore")  # of numbers as damage makes them
def read_parts(
    path: Path,
    take: Callable[[Log], None],
    vehicle: str | Path | VehicleFile | None = None,
    tell: Callable[[float], None] = lambda share: None,
    model: VehicleFile | None = None,
    rate_hz: float | None = None,
) -> ReadingNotes:
    """Read one file part by part: `take` is called with consecutive pieces of what `read` would return.

    Each part is read with the one before it, so that held values and rates are those of the whole log. Two things
    differ: periods and the clock of a recording are measured on a part. Rows older than rows already passed on (a clock
    that goes back, a sensor that is written late) are left out, and a note says so; so is the first row of a sensor
    slower than the parts. `vehicle`, `model` and `rate_hz` are as for `read`; without the first two the columns are
    guessed from the beginning of the file.

    Raises:
        LogError: a format that cannot be read in parts, or a part that cannot be used.
    """
    file = file_of_parts(path)
    if file is None:
        files = files_of(path)
        what = f"{len(files)} files" if len(files) > 1 else f"{known_format(files[0]).title}, which is read whole"
        able = ", ".join(sorted((one.title for one in registered() if one.parts), key=str.casefold))
        raise LogError(f"{path}: this is {what}; give one file of a format that can be read part by part: {able}.")
    described = describe(path, vehicle, model, tell, rate_hz)
    known = described.vehicle
    used = {sensor.file for sensor in known.sensors}
    entries = [entry for entry, _ in pair_files(known, path) if entry.name in used]
    names = frozenset(entry.table for entry in entries if entry.table is not None)
    parts = Joining(file, known, entries, take)
    rest = read_tables(file, Ask(names or None, tell, parts.take))
    parts.take(rest, last=True)
    return parts.said(described.notes)
