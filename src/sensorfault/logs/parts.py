"""A long log part by part, in memory that does not grow with its file."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from sensorfault.logs.guess import guess
from sensorfault.logs.joining import Joining, Said
from sensorfault.logs.place import called_after, files_of, find_vehicle, pair_files
from sensorfault.logs.read import GUESSED
from sensorfault.logs.readers.beginning import is_long
from sensorfault.logs.readers.formats import format_of, known_format, read_tables
from sensorfault.logs.readers.registry import registered
from sensorfault.logs.readers.source import Ask
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile


def file_of_parts(path: Path) -> Path | None:
    """The file of a log that `read_parts` reads: itself, or the only one in a folder; None if there is none."""
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
) -> Said:
    """Read one file and hand it over part by part: `take` hears consecutive pieces of what `read` would return.

    Each part is read with the one before it, so that what is held, or comes at another rate, is what it is in the whole
    log. Two things are not: periods and a recording's clock are told from a part, not from all of it. What
    has times that were handed on before, as a clock goes back or a sensor is written down late, is left out and said;
    of a sensor slower than the parts its first row, too. Without a vehicle.toml the columns are guessed, of a long file
    from its beginning.

    Raises:
        LogError: a format that cannot be read in parts, or whatever keeps a part from being used.
    """
    file = file_of_parts(path)
    if file is None:
        files = files_of(path)
        what = f"{len(files)} files" if len(files) > 1 else f"{known_format(files[0]).title}, which is read whole"
        able = ", ".join(sorted((one.title for one in registered() if one.parts), key=str.casefold))
        raise LogError(f"{path}: this is {what}; what can be read part by part is one file of: {able}.")
    described = find_vehicle(path, vehicle)
    known = called_after(described, path) if described else guess(path, tell)
    used = {sensor.file for sensor in known.sensors}
    entries = [entry for entry, _ in pair_files(known, path) if entry.name in used]
    names = frozenset(entry.table for entry in entries if entry.table is not None)
    parts = Joining(file, known, entries, take)
    rest = read_tables(file, Ask(names or None, tell, parts.take))
    parts.take(rest, last=True)
    return parts.said(() if described else (GUESSED, *known.notes))
