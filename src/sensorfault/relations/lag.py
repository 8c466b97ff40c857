"""The lag of one witness behind the other: receivers are 0.1 to 1 s late."""

import numpy as np
from jaxtyping import Float

from sensorfault.relations.change import change
from sensorfault.relations.grid import STEP_S

LAGS_S = np.round(np.arange(-1.0, 1.01, 0.1), 1)
GAIN = 0.9  # a lag must make the differences this much smaller to be taken
WINDOW_S = 4.0


def shifted(x: Float[np.ndarray, " T"], lag_s: float) -> Float[np.ndarray, " T"]:
    """The same, later by `lag_s`, drawn between ticks."""
    there = np.isfinite(x)
    if lag_s == 0 or there.sum() < 2:
        return x
    tick = np.arange(len(x)) * STEP_S
    out: Float[np.ndarray, " T"] = np.interp(tick - lag_s, tick[there], x[there])
    out[~there] = np.nan
    return out


def fitted(
    left: Float[np.ndarray, " T"], right: Float[np.ndarray, " T"], order: int, lags: Float[np.ndarray, " L"] = LAGS_S
) -> float:
    """How much later `left` is than `right` [s]: what makes their changes most alike; 0 where that is not clear."""
    base = change(left - right, WINDOW_S, order)
    if np.isfinite(base).sum() < 50 or not (usual := float(np.nanmedian(np.abs(base)))):
        return 0.0
    cost = []
    for lag in lags:
        moved = np.abs(change(left - shifted(right, lag), WINDOW_S, order))
        cost.append(float(np.nanmean(np.minimum(moved, 10 * usual))))
    best = int(np.argmin(cost))
    return float(lags[best]) if cost[best] < GAIN * cost[len(lags) // 2] else 0.0
