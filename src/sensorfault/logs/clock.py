"""The time column of a file: strictly increasing seconds from the first row, and notes on what was wrong with it."""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
import polars as pl
from jaxtyping import Float, Int

from sensorfault.logs.phrase import counted, times
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_JITTER = 0.25  # reported if one period in twenty is off by more than this share
HOPELESS = 0.2  # share of rows that may be dropped
_PER_SECOND = {"s": 1, "ms": 1_000, "us": 1_000_000, "ns": 1_000_000_000}
_UNIX_S = (946_684_800.0, 4_102_444_800.0)  # the years 2000 to 2100: a reading between them is Unix time


@dataclass(frozen=True)
class Clock:
    """T rows that are kept. `zero_s`: the column's first reading [s]; `time` [s] counts from there.

    `period_s`: the usual time between two rows [s].
    """

    zero_s: float
    time: Float[np.ndarray, " T"]
    rows: Int[np.ndarray, " T"]
    period_s: float
    notes: tuple[str, ...]

    @property
    def is_unix(self) -> bool:
        """Whether the readings are Unix time."""
        return is_unix(self.zero_s)


def is_unix(time_s: float) -> bool:
    """Whether a reading [s] is Unix time, judged by its size."""
    return _UNIX_S[0] <= time_s < _UNIX_S[1]


def read_clock(source: Source, column: str, unit: str) -> Clock:
    """The clock in a time column.

    Raises:
        LogError: no such column, no times in it, only one row, or more than a fifth of the rows go back in time.
    """
    if column not in source.frame.columns:
        known = ", ".join(source.frame.columns)
        raise LogError(f"{source.path}: there is no time column '{column}'; take one of {known}.")
    zero, time = seconds(source, column, unit)
    name, notes = source.name, []
    usable = np.flatnonzero(np.isfinite(time))
    if len(usable) < len(time):
        bad = int(np.flatnonzero(~np.isfinite(time))[0])
        lost = counted(len(time) - len(usable), "row")
        notes.append(f"{name}: {lost} without a time, first {source.place(bad)}, left out.")
    rows, faults = _rising(source, column, time, usable)
    if len(rows) < 2:
        raise LogError(f"{source.path}: one row is no log; name a file with at least two rows at different times.")
    first = float(time[rows[0]])
    kept = (time if len(rows) == len(time) else time[rows]) - first
    period, unsteady = _steadiness(name, kept)
    return Clock(zero + first, kept, rows, period, (*notes, *faults, *unsteady))


def seconds(source: Source, column: str, unit: str) -> tuple[float, np.ndarray]:
    """The first reading [s] and the seconds since then, NaN where there is none.

    Integers are subtracted as integers: nanoseconds since 1970 would lose 200 ns in a float.

    Raises:
        LogError: no such column, or readings that are no times.
    """
    if unit == "iso8601":
        return _calendar(source, column)
    reading = source.any_column(column)
    reading = reading.dt.epoch("us") / 1e6 if reading.dtype.is_temporal() else source.column(column)
    known = reading.drop_nulls()
    if not len(known):
        raise LogError(f"{source.path}: the time column '{column}' is empty; name another in vehicle.toml.")
    first = known[0]
    per_second = 1 if source.frame[column].dtype.is_temporal() else _PER_SECOND[unit]
    return float(first) / per_second, (reading - first).cast(pl.Float64).to_numpy() / per_second


def _calendar(source: Source, column: str) -> tuple[float, np.ndarray]:
    stamp = source_column = source.any_column(column)
    if not stamp.dtype.is_temporal():
        try:
            stamp = (
                stamp.cast(pl.String).str.strip_chars().str.to_datetime(time_unit="us", strict=False, time_zone="UTC")
            )
        except pl.exceptions.PolarsError:
            stamp = pl.Series(column, [None] * len(stamp), dtype=pl.Datetime("us"))
    bad = (stamp.is_null() & source_column.is_not_null()).arg_true()
    if len(bad):
        row = int(bad[0])
        raise LogError(
            f"{source.path}: {source.place(row)}, column '{column}' holds '{source_column[row]}', which is no date and "
            "time like 2026-11-23T12:00:00.5; correct the cell or the time column's unit."
        )
    ticks = stamp.dt.epoch("us")
    first = ticks.drop_nulls()[0] if ticks.null_count() < len(ticks) else 0
    return first / 1e6, (ticks - first).cast(pl.Float64).to_numpy() / 1e6


def _rising(source: Source, column: str, time: np.ndarray, usable: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """The longest strictly increasing subsequence of rows; one wrong reading costs one row."""
    step = np.diff(time if len(usable) == len(time) else time[usable])
    if not len(step) or step.min() > 0:
        return usable, []
    back, repeat = int(np.sum(step < 0)), int(np.sum(step == 0))
    rows = usable[_longest_rise(time[usable])]
    dropped = len(usable) - len(rows)
    first = int(usable[1 + np.flatnonzero(step <= 0)[0]])
    found = " and ".join(
        text for count, text in ((back, f"goes back {times(back)}"), (repeat, f"stands still {times(repeat)}")) if count
    )
    if dropped > HOPELESS * len(usable):
        raise LogError(
            f"{source.path}: time '{column}' {found} (first {source.place(first)}), so {dropped} of {len(usable)} rows "
            "are out of order; sort the file by time, keep one row for each time, or name another time column."
        )
    lost = counted(dropped, "row")
    return rows, [f"{source.name}: time '{column}' {found} (first {source.place(first)}); {lost} left out."]


def _longest_rise(time: np.ndarray) -> np.ndarray:
    """Indices of the longest strictly rising subsequence (patience sorting)."""
    tails: list[float] = []  # smallest last value of a rise of each length
    last: list[int] = []  # where it is
    before = np.full(len(time), -1)
    for i, value in enumerate(time.tolist()):
        length = bisect_left(tails, value)
        if length == len(tails):
            tails.append(value)
            last.append(i)
        else:
            tails[length], last[length] = value, i
        before[i] = last[length - 1] if length else -1
    rise = np.empty(len(last), int)
    at = last[-1]
    for k in range(len(last) - 1, -1, -1):
        rise[k], at = at, int(before[at])
    return rise


def _steadiness(name: str, time: np.ndarray) -> tuple[float, list[str]]:
    """The usual step, and a sentence on jitter."""
    step = np.diff(time)
    least, most = float(step.min()), float(step.max())
    period = float(np.median(step))
    notes = []
    if max(most - period, period - least) > _JITTER * period:  # else no step is that far off
        off = float(np.quantile(np.abs(step - period), 0.95))
        if off > _JITTER * period:
            notes.append(
                f"{name}: the time between rows jitters: {period:.4g} s usually, one in twenty off by {off:.2g} s or "
                "more."
            )
    return period, notes
