"""The limit that healthy runs pass at a rate, and how well so many runs tell it."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

DRAWS, INNER = 1000, 0.90  # bootstrap samples of runs, and the share of them within the interval


class Calibrated(NamedTuple):
    """`low` to `high`: where the limit would lie in nine of ten sets of as many runs."""

    limit: float
    low: float
    high: float


def calibrated(scores: list[Float[np.ndarray, " T"]], false_alarms: float, seed: int) -> Calibrated:
    """The limit that a share `false_alarms` of the healthy epochs passes; its interval from resampled whole runs.

    `scores`: of each run the largest score of each epoch, NaN where nothing was tested: such an epoch does not count.
    Alarms cluster, so epochs of one run say little more than one of them: the bootstrap draws runs (Davison & Hinkley
    1997, section 2.4, on clusters), not epochs. Without a tested epoch all are inf; where a rate is so small that the
    runs hold not one such epoch, the limit is the largest score seen and says no more than that.
    """
    known = [run[np.isfinite(run)] for run in scores]
    pooled = np.concatenate([*known, np.empty(0)])
    if not pooled.size:
        return Calibrated(np.inf, np.inf, np.inf)
    order = np.argsort(-pooled, kind="stable")
    ranked, run = pooled[order], np.concatenate([np.full(len(x), i) for i, x in enumerate(known)])[order]
    drawn = (
        np.random.default_rng(seed).multinomial(len(known), np.full(len(known), 1 / len(known)), DRAWS).astype(float)
    )
    limits = [_weighted(ranked, times[run], false_alarms) for times in drawn if times[run].any()]
    low, high = np.quantile(limits, ((1 - INNER) / 2, (1 + INNER) / 2))
    return Calibrated(_weighted(ranked, np.ones(len(run)), false_alarms), float(low), float(high))


def _weighted(ranked: Float[np.ndarray, " n"], times: Float[np.ndarray, " n"], share: float) -> float:
    """The smallest value that no more than this share lies above; values in falling order, each so many times."""
    above = np.cumsum(times)
    first = np.searchsorted(above, share * above[-1], side="right")
    return float(ranked[min(first, len(ranked) - 1)])


def epochs(scores: Float[np.ndarray, "T K"], valid: Bool[np.ndarray, "T K"]) -> Float[np.ndarray, " T"]:
    """The largest of the valid scores of each epoch, NaN where there is none."""
    largest = np.where(valid, scores, -np.inf).max(axis=1)
    return np.where(valid.any(axis=1), largest, np.nan)
