"""Readings of a time column, in whatever unit it has, become seconds."""

import numpy as np
import polars as pl

from sensorfault.logs.dates import as_text, microseconds
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.readers.gps_time import WEEK_S, unix_from_gps_week
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError
from sensorfault.logs.time_units import (
    DAY_ZERO,
    ISO,
    JOINED,
    PER_SECOND,
    TICK_ZERO,
    TICKS_PER_SECOND,
    is_calendar,
)

ISO_FORMS = ("%Y-%m-%dT%H:%M:%S%.f", "%Y-%m-%d %H:%M:%S%.f", "%Y-%m-%dT%H:%M:%S%.f%z", "%Y-%m-%d %H:%M:%S%.f%z")
DAY_S = 86_400.0
MENDED = "\x00mended"  # a column of ours: what to add to each reading of the clock [s]


def seconds(source: Source, file: FileEntry) -> tuple[float, np.ndarray]:
    """The first reading [s] and the seconds since then, NaN where there is none; jumps that are known are taken out.

    Raises:
        LogError: as `read_seconds`.
    """
    zero, time = read_seconds(source, file)
    if MENDED not in source.frame.columns:
        return zero, time
    return zero, time + source.frame[MENDED].fill_null(0.0).to_numpy()


def read_seconds(source: Source, file: FileEntry) -> tuple[float, np.ndarray]:
    """The first reading [s] and the seconds since then, NaN where there is none, as the file has them.

    Integers are subtracted as integers: nanoseconds since 1970 would lose 200 ns in a float.

    Raises:
        LogError: no such column, or no reading in it.
    """
    column, unit = time_of(source, file)
    if column is None:  # rows of a known rate
        rate = file.rate_hz or 1.0
        return source.before / rate, np.arange(len(source.frame)) / rate
    cells = source.any_column(column)
    more = None if file.fine is None else source.any_column(file.fine)
    if cells.dtype.is_temporal():
        cells, unit = cells.dt.epoch("us"), "us"
    if is_calendar(unit):
        cells, unit = _calendar(cells, more, unit), "us"
        more = None
    elif not cells.dtype.is_numeric():
        cells = cells.cast(pl.String).str.strip_chars().cast(pl.Float64, strict=False)
    known = cells.drop_nulls()
    if not len(known):
        raise LogError(f"{source.path}: the time column '{column}' holds no time; name another in vehicle.toml.")
    if unit in JOINED:
        return _joined(cells, more, unit)
    first = known[0]
    since: np.ndarray = (cells - first).cast(pl.Float64).to_numpy()
    if unit in DAY_ZERO:
        return (first - DAY_ZERO[unit]) * DAY_S, since * DAY_S
    if unit in TICK_ZERO:
        return (first - TICK_ZERO[unit]) / TICKS_PER_SECOND, since / TICKS_PER_SECOND
    return float(first) / PER_SECOND[unit], since / PER_SECOND[unit]


def time_of(source: Source, file: FileEntry) -> tuple[str | None, str]:
    """The time column and its unit, as described or as the format has it; None where the rows have a rate instead.

    Raises:
        LogError: neither a time nor a rate, or no such column.
    """
    column = file.time or (source.time if file.rate_hz is None else None)
    known = ", ".join(source.frame.columns)
    if column is None and file.rate_hz is None:
        raise LogError(
            f'{source.path}: [file.{file.name}] names no time column; write time = "..." with one of {known}.'
        )
    for name in (column, file.fine):
        if name is not None and name not in source.frame.columns:
            raise LogError(f"{source.path}: there is no time column '{name}'; take one of {known}.")
    return column, source.unit or file.unit


def unreadable(source: Source, file: FileEntry, time: np.ndarray) -> tuple[int, int, str]:
    """How many cells hold something that is no time, the row of the first, and what it holds."""
    column, _ = time_of(source, file)
    if column is None:
        return 0, 0, ""
    cells = source.frame[column]
    bad = np.isnan(time) & cells.is_not_null().to_numpy()
    row = int(np.argmax(bad))
    return int(bad.sum()), row, str(cells[row]) if bad.any() else ""


def _calendar(cells: pl.Series, more: pl.Series | None, unit: str) -> pl.Series:
    if more is not None:
        cells = as_text(cells) + " " + as_text(more)
    if unit != ISO:
        return microseconds(cells, unit)
    found = microseconds(cells, ISO_FORMS[0])
    for form in ISO_FORMS[1:]:
        missed = found.is_null() & cells.is_not_null()
        if not missed.any():
            break
        found = found.zip_with(~missed, microseconds(cells, form))
    return found


def _joined(cells: pl.Series, more: pl.Series | None, unit: str) -> tuple[float, np.ndarray]:
    """Whole seconds, or weeks of GPS time, and a second column with the rest."""
    assert more is not None
    one, two = JOINED[unit]
    large, small = (part.cast(pl.Float64, strict=False).fill_null(np.nan).to_numpy() for part in (cells, more))
    small = small / PER_SECOND[two]
    both = np.flatnonzero(np.isfinite(large) & np.isfinite(small))
    first = int(both[0]) if len(both) else 0
    length = WEEK_S if one == "week" else 1.0
    since: np.ndarray = (large - large[first]) * length + (small - small[first])
    if one == "week" and len(both):
        return unix_from_gps_week(float(large[first]), float(small[first])), since
    return float(large[first] * length + small[first]), since
