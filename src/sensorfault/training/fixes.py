"""A log of an aircraft from one new height to the next, as the multi-step observer steps through it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from sensorfault.logs.table import Log, LogError
from sensorfault.runtime.model import MISSED, hold_s

LEAST_FIXES = 50
GAP_S = 2.0  # over so long a roll-out goes on, whatever the rate of the heights


@dataclass(frozen=True)
class Fixes:
    """New heights and the inputs then, the last that were known.

    `period_s`: the usual time between two; a gap of more than `gap_s` breaks the row, as does an unknown input.
    """

    time: Float[np.ndarray, " T"]  # [s]
    height: Float[np.ndarray, " T"]  # [m]
    inputs: Float[np.ndarray, "T U"]  # [SI]
    columns: tuple[int, ...]
    gap_s: float
    name: str

    @classmethod
    def of(cls, log: Log, height: int, columns: tuple[int, ...]) -> "Fixes":
        """Out of a healthy log; `columns` of the inputs.

        Raises:
            LogError: too few heights.
        """
        new = log.fresh[:, height] & np.isfinite(log.value[:, height])
        if new.sum() < LEAST_FIXES:
            raise LogError(
                f"{log.name} has {new.sum()} measurements of {log.channels[height].path}, the observer needs "
                f"{LEAST_FIXES}; give it more data."
            )
        period_s = float(np.median(np.diff(log.time[new])))
        held = np.column_stack([_held(log, column) for column in columns])
        gap_s = gap(period_s, log.period_s)
        return cls(log.time[new], log.value[new, height], held[new], columns, gap_s, log.name)

    @property
    def period_s(self) -> float:
        """The usual time between two heights [s]."""
        return float(np.median(np.diff(self.time)))

    def windows(self, steps: int) -> Int[np.ndarray, " W"]:
        """First rows of all windows of so many steps without a break."""
        known = np.isfinite(self.inputs).all(axis=1)
        good = (np.diff(self.time) <= self.gap_s) & known[1:] & known[:-1]
        run = np.concatenate([[0], np.cumsum(good)])
        first = np.arange(max(len(run) - steps, 0))
        return np.asarray(first[run[first + steps] - run[first] == steps])

    def scale(self) -> tuple[Float[np.ndarray, " V"], Float[np.ndarray, " V"], float]:
        """Middle and half of the range of height and inputs, and the spread of an increment of one period."""
        seen = np.column_stack([self.height, self.inputs])
        low, high = np.nanmin(seen, axis=0), np.nanmax(seen, axis=0)
        half = np.where(high > low, (high - low) / 2, 1.0)
        dt = np.diff(self.time)
        near = dt <= self.gap_s
        spread = float(np.std(np.diff(self.height)[near] / dt[near])) * self.period_s
        return (low + high) / 2, half, max(spread, 1e-6)


def gap(period_s: float, tick_s: float) -> float:
    """How long a height may be silent before the past is void [s]; half a tick allows for jitter."""
    return max(MISSED * period_s, GAP_S) + tick_s / 2


def _held(log: Log, column: int) -> Float[np.ndarray, " T"]:
    """The last value of a channel, for as long as it stands; NaN before the first and after."""
    came = log.fresh[:, column] & np.isfinite(log.value[:, column])
    last = np.maximum.accumulate(np.where(came, np.arange(len(log)), -1))
    stands = (last >= 0) & (log.time - log.time[last] <= hold_s(log)[column])
    return np.where(stands, log.value[last, column], np.nan)
