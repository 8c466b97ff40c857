"""Clocks that jump by days, or that stand still between whole seconds, are continued; each of it is said."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.logs.readers.source import Source
from sensorfault.logs.set_back import NEAR, set_back

_DAY_S, _WEEK_S = 86_400.0, 604_800.0
_COUNTERS_S = (2**32 / 1e3, 2**32 / 1e6)  # of 32 bits, in milliseconds or microseconds
_JUMP_S = min(_COUNTERS_S) / 2
_FAR_S = _DAY_S / 2  # a clock that is set back by more has not merely been corrected
_PAUSE_S = 600.0  # longest pause that a wrap at midnight, or at the end of a week, may hide
_LASTS = 3  # rows that a jump must last; else it is a wrong reading
_EVEN = 0.8  # share of the runs, or of the steps between them, that must be alike
_RUN = 0.25  # runs of rows are alike if their lengths differ by no more than this share, or by one


@dataclass(frozen=True)
class Step:
    """The clock jumps by `step_s` before `row`; `back_s` is added from there on to take that out [s]."""

    row: int
    step_s: float
    back_s: float


def steps(source: Source, time: Float[np.ndarray, " T"], before: int = 0, begun_s: float = np.nan) -> list[Step]:
    """The jumps of a clock: by days, by its wrap, or back by seconds where it then goes on as before.

    `before`: so many of the times are of a part before the source; `begun_s`: the first time of the first part.

    A wrap of a counter, or of a clock at midnight or at the end of a week, is undone exactly. Otherwise the row after
    the jump comes one usual period after the row before it.
    """
    rows = np.flatnonzero(np.isfinite(time))
    step = np.diff(time[rows])
    period = float(np.median(step[step > 0])) if (step > 0).any() else 1.0
    far = (step < -_JUMP_S) | (step > _WEEK_S / 2)
    back: set[int] = set()
    if (step < -NEAR * period).any():
        begun_s = float(time[rows].min()) if np.isnan(begun_s) else begun_s
        back |= set(set_back(source, rows - before, time[rows], period, begun_s).tolist())
    found, since = [], 0.0
    jumps = np.flatnonzero(far)
    for i in sorted({*jumps.tolist(), *back}):
        lasts = min(i + 1, len(rows) - i - 1, *(np.abs(jumps[jumps != i] - i)), _LASTS)
        more = period - step[i] if i in back else _wrapped(step[i], period, since)
        if lasts >= _LASTS and more is not None:
            found.append(Step(int(rows[i + 1]), float(step[i]), float(more)))
            since += more
    return found


def continued(time: Float[np.ndarray, " T"], jumps: list[Step]) -> Float[np.ndarray, " T"]:
    """The time with its jumps taken out."""
    moved = time.copy() if jumps else time
    for jump in jumps:
        moved[jump.row :] += jump.back_s
    return moved


def _wrapped(step: float, period: float, since: float) -> float | None:
    """What to add after a step to take a jump out; None if it is no jump. `since`: what was added before."""
    weeks = round(step / _WEEK_S) * _WEEK_S
    cycles = ((weeks, _PAUSE_S if step < 0 else NEAR * period), (-_DAY_S, _PAUSE_S))
    for wrap, longest in (*cycles, *((-counter, NEAR * period) for counter in _COUNTERS_S)):
        rest = step - wrap
        if wrap and -period / 2 < rest < max(longest, NEAR * period):
            return rest - step if rest > 0 else period - step
    if step < -_FAR_S or (since and abs(step - since) < _WEEK_S / 2):
        return period - step
    return None


def wraps(reading_s: float, step_s: float) -> bool:
    """Whether a jump to this reading is that of a clock which counts to the end of a day or week, or of 32 bits."""
    begins = 0 <= reading_s < _PAUSE_S
    return begins and any(abs(cycle + step_s) < _PAUSE_S for cycle in (_DAY_S, _WEEK_S, *_COUNTERS_S))


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
