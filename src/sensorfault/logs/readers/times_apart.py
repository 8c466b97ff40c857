"""Text tables without a time, and `time.csv` beside them with the times of their rows, one a line."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import polars as pl

from sensorfault.logs.readers.cells import is_number
from sensorfault.logs.readers.dialect import sniff
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

TIME = "time"
_TIMES = re.compile(r"t|times?|time_?stamps?", re.IGNORECASE)
_CLOCK = re.compile(r"time|stamp|date|epoch|^t\b", re.IGNORECASE)
_HEAD_BYTES = 256


def times_beside(path: Path, names: Sequence[str]) -> Path | None:
    """The file of times that lies beside a table of these columns, if none of them is a time by its name."""
    if any(_CLOCK.search(name) for name in names):
        return None
    same = (file for file in path.parent.glob(f"*{path.suffix}") if file != path and _is_column(file))
    return min(same, default=None)


def table_timed(path: Path) -> Path:
    """Of a file of times, the first table that it is the clock of; of any other, itself."""
    if not _is_column(path):
        return path
    others = sorted(file for file in path.parent.glob(f"*{path.suffix}") if file != path)
    return next((file for file in others if times_beside(file, _columns(file)) == path), path)


def with_times(source: Source) -> Source:
    """The table with the times that lie beside it as its first column, if there are as many as it has rows.

    The last time may have no row: a command is given for each step, a state is measured before and after it.

    Raises:
        LogError: a line of the times is no number.
    """
    file, rows = times_beside(source.path, source.frame.columns), len(source.frame)
    if file is None:
        return source
    cells = pl.Series([line.strip() for line in file.read_text("utf-8", "replace").splitlines() if line.strip()])
    if not is_number(cells[0]):
        cells = cells[1:]  # below its header
    if len(cells) - rows not in (0, 1):
        said = f"{source.path.name}: {file.name} has {len(cells)} times for {rows} rows, so its times were not used."
        return replace(source, notes=(*source.notes, said))
    time = cells.cast(pl.Float64, strict=False)
    if time.null_count():
        raise LogError(f"{file}: '{cells.filter(time.is_null())[0]}' is not a time; write one number per line.")
    return replace(source, frame=source.frame.select(time[:rows].alias(TIME), pl.all()), times=file)


def _is_column(path: Path) -> bool:
    """Whether a file is called like times, and begins with numbers, one a line."""
    if not _TIMES.fullmatch(path.stem) or not path.is_file():
        return False
    with path.open("rb") as file:
        lines = file.read(_HEAD_BYTES).decode("utf-8", "replace").splitlines()
    return len(lines) > 2 and all(is_number(line.strip()) for line in lines[1:-1])


def _columns(path: Path) -> Sequence[str]:
    try:
        return sniff(path).names
    except LogError:
        return [TIME]  # no table that times are missing in
