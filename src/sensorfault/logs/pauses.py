"""Pauses of a recording: times in which nothing was written down, whatever the sensors did."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.phrase import counted

GAP = 3.0  # a gap is longer than this many usual periods
_DUE = 1.5  # a row is overdue after this many periods
_ALIKE_S = 1e-6  # a row this close to the end of a gap is at its end

Pauses = Float[np.ndarray, "P 2"]  # start and end [s] of each


def pauses_of(time: Float[np.ndarray, " T"], period_s: float) -> Pauses:
    """The steps of a clock that are longer than GAP periods."""
    long = np.flatnonzero(np.diff(time) > GAP * period_s)
    return np.column_stack([time[long], time[long + 1]])


def shared_pauses(times: Sequence[np.ndarray], periods_s: Sequence[float], tick_s: float) -> Pauses:
    """Times without a row of any file, in which at least two that were alive should have written one.

    Where only one should have, it may as well be a dropout of that one.

    Args:
        times: of each file's rows, on one clock [s].
        periods_s: usual time between two rows of each [s].
        tick_s: usual time between two ticks of the log [s], which says what is a gap.
    """
    gaps = pauses_of(np.sort(np.concatenate(times)), tick_s)
    due = np.zeros(len(gaps), int)
    for time, period_s in zip(times, periods_s, strict=True):
        due += _due(time, period_s, gaps)
    return gaps[due >= 2]


def _due(time: Float[np.ndarray, " T"], period_s: float, gaps: Pauses) -> Bool[np.ndarray, " P"]:
    """Whether a file that was alive before the gap should have written a row in it."""
    before = np.searchsorted(time, gaps[:, 0] + _ALIKE_S, side="right") - 1
    last = np.where(before >= 0, time[np.maximum(before, 0)], -np.inf)
    alive = last >= gaps[:, 0] - GAP * period_s
    due: Bool[np.ndarray, " P"] = alive & (last + _DUE * period_s < gaps[:, 1])
    return due


def recorded(time: Float[np.ndarray, " T"], pauses: Pauses) -> Float[np.ndarray, " T"]:
    """The time without the pauses before it [s]."""
    if not len(pauses):
        return time
    lasted = np.cumsum(pauses[:, 1] - pauses[:, 0])
    paused: Float[np.ndarray, " T"] = np.interp(
        time, pauses.ravel(), np.column_stack([lasted - (pauses[:, 1] - pauses[:, 0]), lasted]).ravel()
    )
    left: Float[np.ndarray, " T"] = time - paused
    return left


def gaps_said(
    name: str, time: Float[np.ndarray, " T"], period_s: float, pauses: Pauses, since_s: float = -np.inf
) -> list[str]:
    """A sentence on the gaps of one file, from `since_s` on, that are not only pauses of the whole recording."""
    step = np.diff(recorded(time, pauses))
    step[time[:-1] < since_s] = 0.0
    long = step > GAP * period_s
    if not long.any():
        return []
    worst = int(np.argmax(step))
    return [
        f"{name}: {counted(int(long.sum()), 'gap')} longer than {GAP:g} periods of {period_s:.4g} s, the longest "
        f"{step[worst]:.4g} s at {time[worst]:.3f} s; left as gaps."
    ]


def pauses_said(pauses: Pauses) -> list[str]:
    """A sentence on the pauses of a recording, of all together."""
    if not len(pauses):
        return []
    lasts = pauses[:, 1] - pauses[:, 0]
    worst = int(np.argmax(lasts))
    total, longest = (f"{x:.3g}" if x < 1000 else f"{x:.0f}" for x in (lasts.sum(), lasts[worst]))
    return [
        f"The recording has {counted(len(pauses), 'gap')}, {total} s in all, the longest {longest} s at "
        f"{pauses[worst, 0]:.3f} s; nothing is judged there, and no sensor is called missing."
    ]
