"""The limit for a designed false alarm rate, and its confidence interval from the number of healthy runs."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

DRAWS, INNER = 1000, 0.90  # bootstrap samples, and the confidence of the interval


class Calibrated(NamedTuple):
    """A limit and its 90 % interval over sets of as many runs."""

    limit: float
    low: float
    high: float


def calibrated(scores: list[Float[np.ndarray, " T"]], false_alarms: float, seed: int) -> Calibrated:
    """The limit that a share `false_alarms` of the healthy epochs exceeds; its interval by resampling whole runs.

    `scores`: for each run the largest score of each epoch; NaN where nothing was tested, such epochs do not count.
    Alarms come in clusters, so the bootstrap draws whole runs, not epochs (Davison & Hinkley 1997, section 2.4).
    Without a tested epoch limit and interval are inf. If the rate is below one epoch of all runs, the limit is the
    largest score.
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
    """Smallest value with at most this share above it. `ranked`: values in falling order; `times`: their weights."""
    above = np.cumsum(times)
    first = np.searchsorted(above, share * above[-1], side="right")
    return float(ranked[min(first, len(ranked) - 1)])


def epochs(scores: Float[np.ndarray, "T K"], valid: Bool[np.ndarray, "T K"]) -> Float[np.ndarray, " T"]:
    """The largest of the valid scores of each epoch, NaN where there is none."""
    largest = np.where(valid, scores, -np.inf).max(axis=1)
    return np.where(valid.any(axis=1), largest, np.nan)
