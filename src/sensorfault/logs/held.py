"""Zero-order hold: values that a file repeats between measurements. A repeated row is not a new measurement."""

import numpy as np
from jaxtyping import Bool, Float

HELD_SHARE = 0.3  # a sensor is held if more than this share of its measurements is repeated in the next row
STALE = 10.0  # a receiver without a new measurement for this many periods has dropped out
_REGULAR = 0.88  # share of measurements that last as long as usual, give or take a row
_SHORTEST = 0.6  # one in five may last for less than this share of the usual


def repeats(value: Float[np.ndarray, "T C"]) -> Bool[np.ndarray, " T"]:
    """Rows in which every channel equals the last row with any value."""
    present = np.flatnonzero(_any_finite(value))
    rows = value if len(present) == len(value) else value[present]
    same = np.ones(max(len(rows) - 1, 0), bool)
    for channel in rows.T:
        now, before = channel[1:], channel[:-1]
        same &= (now == before) | (np.isnan(now) & np.isnan(before))
    repeated = np.zeros(len(value), bool)
    repeated[present[1:]] = same
    return repeated


def share_repeated(value: Float[np.ndarray, "T C"]) -> float:
    """Share of the rows with a value that only repeat the row before."""
    present = int(_any_finite(value).sum())
    return float(repeats(value).sum()) / present if present else 0.0


def share_old(value: Float[np.ndarray, "T C"], fresh: Bool[np.ndarray, "T C"]) -> float:
    """Share of the rows with a value that have no new measurement of any channel."""
    present = int(_any_finite(value).sum())
    return 1 - float(any_of(fresh).sum()) / present if present else 0.0


def looks_held(value: Float[np.ndarray, "T C"]) -> bool:
    """Whether the sensor is held: many of its measurements are repeated, about equally often.

    Measurements are counted, not rows, so one long standstill (a parked car, an airspeed of zero) is no hold. A coarse
    reading that happens not to change repeats irregularly; that is no hold either. Rows without a value do not count.
    """
    value = value[_any_finite(value)]
    start = np.flatnonzero(~repeats(value))
    if len(start) < 3:
        return False
    lasts = np.diff(start)
    if float(np.mean(lasts > 1)) <= HELD_SHARE:
        return False
    usual = float(np.median(lasts))
    if usual <= 2:
        return float(np.mean(np.abs(lasts - usual) <= 1)) > _REGULAR and float(np.mean(lasts == 1)) < 1 - HELD_SHARE
    return float(np.quantile(lasts, 0.2)) >= _SHORTEST * usual


def stale(time: Float[np.ndarray, " T"], fresh: Bool[np.ndarray, "T C"], period_s: float) -> Bool[np.ndarray, " T"]:
    """Rows more than STALE periods after the last measurement: a value that is still repeated there is too old.

    Only for a sensor with an epoch column: without it, a parked car looks the same.
    """
    last = np.maximum.accumulate(np.where(any_of(fresh), time, time[0]))
    late: Bool[np.ndarray, " T"] = time - last > STALE * period_s
    return late


def changes(epoch: Float[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
    """Rows in which an epoch column differs from the row before; NaN: no measurement yet."""
    known = np.isfinite(epoch)
    new: Bool[np.ndarray, " T"] = known.copy()
    new[1:] &= ~(known[:-1] & (epoch[1:] == epoch[:-1]))
    return new


def fresh_rows(
    value: Float[np.ndarray, "T C"], held: bool, epoch: Float[np.ndarray, " T"] | None
) -> Bool[np.ndarray, "T C"]:
    """Which values are new measurements.

    Not held: every value. Held: where the epoch column changes, or, without one, where any channel changed.
    """
    fresh: Bool[np.ndarray, "T C"] = np.isfinite(value)
    if epoch is not None:
        fresh &= changes(epoch)[:, None]
    elif held:
        fresh &= ~repeats(value)[:, None]
    return fresh


def usual_period_s(time: Float[np.ndarray, " T"], fresh: Bool[np.ndarray, "T C"], row_s: float) -> float:
    """Median time between new measurements [s], between two rows `row_s`; NaN with fewer than two.

    A long standstill, where a held value cannot change, is one gap among many and does not move the median.
    """
    new = any_of(fresh)
    if new.all():
        return row_s
    at: Float[np.ndarray, " N"] = time[new]
    return float(np.median(np.diff(at))) if len(at) > 1 else float("nan")


def _any_finite(value: Float[np.ndarray, "T C"]) -> Bool[np.ndarray, " T"]:
    return any_of(np.isfinite(value))


def any_of(mark: Bool[np.ndarray, "T C"]) -> Bool[np.ndarray, " T"]:
    """`mark.any(axis=1)`, by columns: ten times as fast for few columns and many rows."""
    found = np.zeros(len(mark), bool)
    for channel in mark.T:
        found |= channel
    return found
