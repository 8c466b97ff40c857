"""Limits from the scores of healthy data."""

import numpy as np
from jaxtyping import Float

REPEATS_PER_HOUR = 1e-3  # false alarms an hour of the exact-repeat test of one channel
LEAST_RUN = 4.0
FEW = 50  # with so many blocks the estimated tail shape has weight one half


def repeat_limit(runs: Float[np.ndarray, "T C"], period_s: float) -> Float[np.ndarray, " C"]:
    """Longest run of exact repeats that is still healthy, for each channel.

    If repeats are independent with probability p, a run longer than n begins p^n / period times a second; this is
    solved for n at REPEATS_PER_HOUR, with the upper 95 % bound of p where few repeats were seen (rule of three). A
    channel with long runs of repeats (a wheel at rest) gets twice its longest healthy run. `runs` is NaN where nothing
    was tested.
    """
    tested = np.isfinite(runs)
    count = np.maximum(tested.sum(axis=0), 1)
    p = np.clip(((np.nan_to_num(runs) > 0).sum(axis=0) + 3) / count, 1e-9, 1 - 1e-9)
    # p^n 3600 / period = rate
    chance = np.log(REPEATS_PER_HOUR * period_s / 3600) / np.log(p)
    longest = np.nan_to_num(runs).max(axis=0)
    limit = np.maximum(np.maximum(np.ceil(chance), 2 * longest), LEAST_RUN)
    return np.where(tested.any(axis=0), limit, np.inf)


def tail_limit(
    scores: Float[np.ndarray, "T K"], period_s: float, per_hour: float, block_s: float = 5.0
) -> Float[np.ndarray, " K"]:
    """Limit that healthy data exceed `per_hour` times an hour, for each test; at least the largest healthy score.

    Rows are `period_s` apart, NaN where nothing was tested. Alarms come in clusters, so the maxima of blocks of
    `block_s` count, not rows. A generalised Pareto distribution is fitted to the upper half of the maxima (at least 10)
    by probability-weighted moments (Hosking & Wallis 1987). Its shape is kept between 0 (exponential) and 0.5, and
    shrunk towards 0 where there are few blocks. A test without any score gets +inf.
    """
    rows = max(round(block_s / period_s), 1)
    limit = np.full(scores.shape[1], np.inf)
    for k, score in enumerate(scores.T):
        tested = score[np.isfinite(score)]
        if not tested.size:
            continue
        length = max(round(rows * tested.size / len(score)), 1)  # blocks contain tested rows only
        blocks = -(-tested.size // length)
        padded = np.concatenate([tested, np.full(blocks * length - tested.size, -np.inf)])
        top = np.sort(padded.reshape(blocks, length).max(axis=1))[::-1]
        many = min(max(blocks // 2, 10), blocks - 1)
        hours = len(score) * period_s / 3600
        limit[k] = top[0]
        if many >= 2:
            scale, shape = _pareto(top[:many] - top[many])
            # many / hours (1 + shape x / scale)^(-1/shape) = per_hour
            ratio = max(many / hours / per_hour, 1.0)
            beyond = scale * np.log(ratio) if shape < 1e-9 else scale / shape * (ratio**shape - 1)
            limit[k] = max(top[0], top[many] + beyond)
    return limit


def _pareto(over: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """Scale and shape of a generalised Pareto law for excesses, largest first (Hosking & Wallis 1987, section 4)."""
    n = len(over)
    # a0 = E x, a1 = E x (1 - F(x)); plotting positions (i - 0.35) / n from the smallest
    rest = (np.arange(n) + 0.35) / n
    a0, a1 = float(over.mean()), float((over * rest).mean())
    if a0 <= 2 * a1 or a0 <= 0:
        return max(a0, 0.0), 0.0
    shape = float(np.clip(2 - a0 / (a0 - 2 * a1), 0.0, 0.5)) * n / (n + FEW)
    return a0 * (1 - shape), shape
