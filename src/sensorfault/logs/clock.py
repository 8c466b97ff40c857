"""The time column of a file: strictly increasing seconds from the first row, and notes on what was wrong with it."""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from sensorfault.logs.clock_steps import Step, continued, spread, steps, wraps
from sensorfault.logs.dates import READABLE
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.jumps import Jump
from sensorfault.logs.phrase import counted, times
from sensorfault.logs.readers.source import Source
from sensorfault.logs.stamps import seconds, time_of, unreadable
from sensorfault.logs.table import LogError
from sensorfault.logs.time_units import is_calendar

_JITTER = 0.25  # reported if one period in twenty is off by more than this share
HOPELESS = 0.2  # share of rows that may be dropped
_UNIX_S = (946_684_800.0, 4_102_444_800.0)  # the years 2000 to 2100: a reading between them is Unix time


@dataclass(frozen=True)
class Clock:
    """T rows that are kept. `zero_s`: the column's first reading [s]; `time` [s] counts from there.

    `period_s`: the usual time between two rows [s]. `jumps`: of the column, by days or back by seconds,
    taken out; those at the end of a day or a week, or of a counter's bits, are none.
    """

    zero_s: float
    time: Float[np.ndarray, " T"]
    rows: Int[np.ndarray, " T"]
    period_s: float
    notes: tuple[str, ...]
    jumps: tuple[Jump, ...] = ()

    @property
    def is_unix(self) -> bool:
        """Whether the readings are Unix time."""
        return is_unix(self.zero_s)


def is_unix(time_s: float) -> bool:
    """Whether a reading [s] is Unix time, judged by its size."""
    return _UNIX_S[0] <= time_s < _UNIX_S[1]


def read_clock(source: Source, file: FileEntry) -> Clock:
    """The clock in a file's time column, or of its rate.

    Raises:
        LogError: no such column, no times in it, only one row, or more than a fifth of the rows go back in time.
    """
    zero, time = seconds(source, file)
    column = time_of(source, file)[0]
    if column is None:
        said = f"{source.name}: it has no clock; its rows are taken as {file.rate_hz:g} a second, as given."
        if len(time) < 2:
            raise LogError(f"{source.path}: one row is no log; name a file with at least two rows.")
        return Clock(zero, time, np.arange(len(time)), 1 / (file.rate_hz or 1.0), (said,))
    notes = _without_time(source, file, time)
    jumped, read = steps(source, time), time
    time = continued(time, jumped)
    time, even = spread(source, column, time)
    usable = np.flatnonzero(np.isfinite(time))
    rows, faults = _rising(source, column, time, usable)
    if len(rows) < 2:
        raise LogError(f"{source.path}: one row is no log; name a file with at least two rows at different times.")
    first = float(time[rows[0]])
    kept = (time if len(rows) == len(time) else time[rows]) - first
    period, unsteady = _steadiness(source.name, kept)
    jumps = tuple(Jump(float(time[one.row]) - first, -one.back_s, column) for one in jumped)
    faulty = tuple(j for j, one in zip(jumps, jumped, strict=True) if not wraps(zero + float(read[one.row]), j.step_s))
    sentences = [_said(source, one, jump) for one, jump in zip(jumped, jumps, strict=True)]
    return Clock(zero + first, kept, rows, period, (*notes, *sentences, *even, *faults, *unsteady), faulty)


def _said(source: Source, step: Step, jump: Jump) -> str:
    return f"{source.name}: {jump.said} at {source.place(step.row)}; from there on it is continued without the jump."


def _without_time(source: Source, file: FileEntry, time: np.ndarray) -> list[str]:
    """A sentence on rows without a time.

    Raises:
        LogError: too many cells hold something that is no time.
    """
    lost = int((~np.isfinite(time)).sum())
    if not lost:
        return []
    column, unit = time_of(source, file)
    count, row, cell = unreadable(source, file, time)
    if count > HOPELESS * len(time):
        wanted = "a date or clock of its form" if is_calendar(unit) else "a number"
        raise LogError(
            f"{source.path}: {source.place(row)}, column '{column}' holds '{cell}', which is not {wanted}; correct the "
            f"cells or the time column's unit. Times are read as {READABLE}."
        )
    said = f" ('{cell}' in {source.place(row)} is no time)" if count else ""
    bad = int(np.flatnonzero(~np.isfinite(time))[0])
    return [f"{source.name}: {counted(lost, 'row')} without a time, first {source.place(bad)}, left out{said}."]


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
