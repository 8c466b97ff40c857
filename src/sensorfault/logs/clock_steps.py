"""Clocks that jump by days, or that stand still between whole seconds, are continued; each of it is said."""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.readers.source import Source

_DAY_S, _WEEK_S = 86_400.0, 604_800.0
_COUNTERS_S = (2**32 / 1e3, 2**32 / 1e6)  # of 32 bits, in milliseconds or microseconds
_JUMP_S = min(_COUNTERS_S) / 2
_FAR_S = _DAY_S / 2  # a clock that is set back by more has not merely been corrected
_PAUSE_S = 600.0  # longest pause that a wrap at midnight, or at the end of a week, may hide
_NEAR = 3.0  # the same for counters, in usual periods
_LASTS = 3  # rows that a jump must last; else it is a wrong reading
_EVEN = 0.8  # share of the runs, or of the steps between them, that must be alike
_RUN = 0.25  # runs of rows are alike if their lengths differ by no more than this share, or by one


def continued(source: Source, column: str, time: Float[np.ndarray, " T"]) -> tuple[Float[np.ndarray, " T"], list[str]]:
    """The time with its jumps by days taken out, and a sentence for each.

    A wrap of a counter, or of a clock at midnight or at the end of a week, is undone exactly. Otherwise the row after
    the jump comes one usual period after the row before it.
    """
    rows = np.flatnonzero(np.isfinite(time))
    step = np.diff(time[rows])
    jumps = np.flatnonzero((step < -_JUMP_S) | (step > _WEEK_S / 2))
    if not len(jumps):
        return time, []
    period = float(np.median(step[step > 0])) if (step > 0).any() else 1.0
    shift, notes, since = np.zeros(len(rows)), [], 0.0
    for i in jumps:
        lasts = min(i + 1, len(rows) - i - 1, *(np.abs(jumps[jumps != i] - i)), _LASTS)
        back = _wrapped(step[i], period, since)
        if lasts < _LASTS or back is None:
            continue
        shift[i + 1 :] += back
        since += back
        way = "back" if step[i] < 0 else "ahead"
        place = source.place(int(rows[i + 1]))
        notes.append(
            f"{source.name}: the clock '{column}' jumps {way} by {_spoken(abs(step[i]))} at {place}; "
            "from there on it is continued without the jump."
        )
    moved = time.copy()
    moved[rows] += shift
    return moved, notes


def _wrapped(step: float, period: float, since: float) -> float | None:
    """What to add after a step to take a jump out; None if it is no jump. `since`: what was added before."""
    weeks = round(step / _WEEK_S) * _WEEK_S
    cycles = ((weeks, _PAUSE_S if step < 0 else _NEAR * period), (-_DAY_S, _PAUSE_S))
    for wrap, longest in (*cycles, *((-counter, _NEAR * period) for counter in _COUNTERS_S)):
        rest = step - wrap
        if wrap and -period / 2 < rest < max(longest, _NEAR * period):
            return rest - step if rest > 0 else period - step
    if step < -_FAR_S or (since and abs(step - since) < _WEEK_S / 2):
        return period - step
    return None


def _spoken(length_s: float) -> str:
    days = length_s / 86_400
    return f"{length_s:.6g} s" if days < 0.5 else f"{days:.4g} days"


def spread(source: Source, column: str, time: Float[np.ndarray, " T"]) -> tuple[Float[np.ndarray, " T"], list[str]]:
    """Rows of one and the same reading, as of a clock in whole seconds, evenly over the time to the next reading.

    Only where nearly all readings are repeated equally often, and are equally far apart.
    """
    rows = np.flatnonzero(np.isfinite(time))
    step = np.diff(time[rows])
    if len(step) < 4 or (step < 0).any() or np.mean(step == 0) < 0.4:
        return time, []
    starts = np.append(0, np.flatnonzero(step > 0) + 1)
    length = np.diff(np.append(starts, len(rows)))
    if len(starts) < 4:
        return time, []
    usual, apart = float(np.median(length[1:-1])), np.diff(time[rows[starts]])
    resolution = float(np.median(apart))
    alike = np.abs(length[1:-1] - usual) <= max(1.0, _RUN * usual)
    even = np.abs(apart - resolution) <= 0.01 * resolution
    if usual < 2 or alike.mean() < _EVEN or even.mean() < _EVEN:
        return time, []
    run = np.repeat(np.arange(len(starts)), length)
    place = np.arange(len(rows)) - starts[run]
    share = np.maximum(length, 1)[run].astype(float)
    share[run == len(starts) - 1] = np.maximum(usual, share[run == len(starts) - 1])
    first = run == 0
    share[first] = max(usual, float(length[0]))
    place[first] += int(share[0]) - int(length[0])  # recording began within the first second
    moved = time.copy()
    moved[rows] = time[rows] + resolution * place / share
    said = (
        f"{source.name}: time '{column}' has about {usual:g} rows for each reading; they are spread evenly over the "
        f"{resolution:.3g} s to the next one."
    )
    return moved, [said]
