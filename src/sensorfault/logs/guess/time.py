"""Which column is the time, and in what unit."""

import re

import polars as pl

from sensorfault.logs.dates import READABLE
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.guess.clock_pairs import pairs
from sensorfault.logs.guess.clocks import Candidate, candidate, unit_by_form
from sensorfault.logs.guess.time_names import is_plain
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError
from sensorfault.logs.time_units import PER_SECOND
from sensorfault.logs.vehicle import sound_rate


def guess_time(source: Source, rate_hz: float | None = None) -> FileEntry:
    """The time of a table: its column or two, the unit and the reason. `rate_hz`: rows a second if there is no clock.

    Raises:
        LogError: no column is a clock by its name, unit or form, and there is no rate.
    """
    if source.time is not None:
        why = f"{source.path.suffix} files have a time column"
        form = unit_by_form(source.frame[source.time], named=False) if source.unit is None else None
        unit = source.unit or (form if form in PER_SECOND else None) or "s"
        return FileEntry(time=source.time, unit=unit, why=why)
    headed = not all(re.fullmatch(r"c\d+", name) for name in source.frame.columns)
    found = _candidates(source, headed)
    able = (
        [one for one in found if one.runs]
        or [one for one in found if one.stands]
        or [one for one in found if one.file.time and is_plain(one.file.time)]
    )
    unread = _unread(source, found) if headed else None
    if not able or (unread is not None and not any(one.named for one in able)):
        if rate_hz is not None:
            return FileEntry(rate_hz=sound_rate(rate_hz), why="rows a second, as given")
        raise unread or LogError(
            f"{source.path}: there is no time column: no column is a clock by its name, its unit or its form; name one "
            "in vehicle.toml, or give --rate, the rows a second."
        )
    best = max(range(len(able)), key=lambda i: (*able[i].rank, -i))
    return able[best].file


def _candidates(source: Source, headed: bool) -> list[Candidate]:
    """All that may be the clock; a column that is one half of a pair does not stand alone."""
    joined = pairs(source) if headed else []
    halves = {name for one in joined for name in (one.file.time, one.file.fine)}
    alone = [candidate(source, name, headed) for name in source.frame.columns if name not in halves]
    return [*(one for one in alone if one is not None), *joined]


def _unread(source: Source, found: list[Candidate]) -> LogError | None:
    """What is said of a column that is called time and cannot be read, if there is one."""
    read = {one.file.time for one in found}
    for name in source.frame.columns:
        cells = source.frame[name]
        if name in read or not is_plain(name) or cells.dtype != pl.String or not cells.count():
            continue
        row = int(cells.is_not_null().arg_max() or 0)
        return LogError(
            f"{source.path}: {source.place(row)}, column '{name}' holds '{cells[row]}', which is no time that can be "
            f"read. Times are read as {READABLE}; write another form into vehicle.toml (unit = "
            '"%d.%m.%Y %H:%M:%S").'
        )
    return None
