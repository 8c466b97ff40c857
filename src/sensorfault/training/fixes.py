"""The new heights of an aircraft's log, through which the multi-step observer steps."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from sensorfault.logs.rates import MISSED, hold_s
from sensorfault.logs.table import Log, LogError

LEAST_FIXES = 50
GAP_S = 2.0  # a roll-out continues over a gap of at least this length, whatever the rate of the heights [s]


@dataclass(frozen=True)
class Fixes:
    """New heights, and the last known inputs at these times.

    A gap of more than `gap_s` or an unknown input ends a run of heights.
    """

    time: Float[np.ndarray, " T"]  # [s]
    height: Float[np.ndarray, " T"]  # [m]
    inputs: Float[np.ndarray, "T U"]  # [SI]
    columns: tuple[int, ...]
    gap_s: float
    name: str

    @classmethod
    def of(cls, log: Log, height: int, columns: tuple[int, ...]) -> "Fixes":
        """From a healthy log; `columns`: of the inputs.

        Raises:
            LogError: too few heights.
        """
        new = log.fresh[:, height] & np.isfinite(log.value[:, height])
        if new.sum() < LEAST_FIXES:
            raise LogError(
                f"{log.name} has {new.sum()} measurements of {log.channels[height].path}, but the observer needs "
                f"{LEAST_FIXES}; give it more data."
            )
        period_s = float(np.median(np.diff(log.time[new])))
        held = np.column_stack([_held(log, column) for column in columns])
        gap_s = gap(period_s, log.period_s)
        return cls(log.time[new], log.value[new, height], held[new], columns, gap_s, log.name)

    @property
    def period_s(self) -> float:
        """Median time between two heights [s]."""
        return float(np.median(np.diff(self.time)))

    def windows(self, steps: int) -> Int[np.ndarray, " W"]:
        """First rows of all windows of so many steps without a gap."""
        known = np.isfinite(self.inputs).all(axis=1)
        good = (np.diff(self.time) <= self.gap_s) & known[1:] & known[:-1]
        run = np.concatenate([[0], np.cumsum(good)])
        first = np.arange(max(len(run) - steps, 0))
        return np.asarray(first[run[first + steps] - run[first] == steps])

    def scale(self) -> tuple[Float[np.ndarray, " V"], Float[np.ndarray, " V"], float]:
        """Middle and half-width of the range of height and inputs, and the spread of an increment in one period."""
        seen = np.column_stack([self.height, self.inputs])
        low, high = np.nanmin(seen, axis=0), np.nanmax(seen, axis=0)
        half = np.where(high > low, (high - low) / 2, 1.0)
        dt = np.diff(self.time)
        near = dt <= self.gap_s
        spread = float(np.std(np.diff(self.height)[near] / dt[near])) * self.period_s
        return (low + high) / 2, half, max(spread, 1e-6)


def gap(period_s: float, tick_s: float) -> float:
    """After a silence of the height longer than this the past is discarded [s]; half a tick allows for jitter."""
    return max(MISSED * period_s, GAP_S) + tick_s / 2


def _held(log: Log, column: int) -> Float[np.ndarray, " T"]:
    """The last value of a channel while it is valid; NaN before the first value and after it expires."""
    came = log.fresh[:, column] & np.isfinite(log.value[:, column])
    last = np.maximum.accumulate(np.where(came, np.arange(len(log)), -1))
    stands = (last >= 0) & (log.time - log.time[last] <= hold_s(log)[column])
    return np.where(stands, log.value[last, column], np.nan)
