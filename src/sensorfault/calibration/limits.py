"""Limits from the scores of healthy data."""

import numpy as np
from jaxtyping import Float

REPEATS_PER_HOUR = 1e-3  # false alarms allowed to the whole exact-repeat test of a channel
LEAST_RUN = 4.0
FEW = 50  # so many blocks tell half of a tail's shape


def repeat_limit(runs: Float[np.ndarray, "T C"], period_s: float) -> Float[np.ndarray, " C"]:
    """Longest run of exact repeats that health still explains, for each channel.

    With repeats independent of chance p, a run longer than n begins p^n / period times a second; solve for n at
    REPEATS_PER_HOUR, p taken at its upper 95 % bound where few were seen (rule of three). A channel whose repeats come
    in long runs (a wheel at rest) is given twice its longest healthy run. `runs` is NaN where nothing was tested.
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
    """Limit that health passes `per_hour` times an hour, for each test; at least its largest healthy score.

    Rows are `period_s` apart, NaN where nothing was tested. Alarms cluster, so blocks are counted, not rows: the maxima
    of blocks of `block_s`, of which the upper half (but 10 at least) is taken for the tail, a generalised Pareto law by
    probability-weighted moments (Hosking & Wallis 1987), its shape kept within 0 (exponential) to 0.5 and shrunk to 0
    where few blocks tell it. A test without any score gets +inf.
    """
    rows = max(round(block_s / period_s), 1)
    limit = np.full(scores.shape[1], np.inf)
    for k, score in enumerate(scores.T):
        tested = score[np.isfinite(score)]
        if not tested.size:
            continue
        length = max(round(rows * tested.size / len(score)), 1)  # blocks are cut out of what was tested
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
    """Scale and shape of a generalised Pareto law of excesses, largest first (Hosking & Wallis 1987, section 4)."""
    n = len(over)
    # a0 = E x, a1 = E x (1 - F(x)); plotting positions (i - 0.35) / n from the smallest
    rest = (np.arange(n) + 0.35) / n
    a0, a1 = float(over.mean()), float((over * rest).mean())
    if a0 <= 2 * a1 or a0 <= 0:
        return max(a0, 0.0), 0.0
    shape = float(np.clip(2 - a0 / (a0 - 2 * a1), 0.0, 0.5)) * n / (n + FEW)
    return a0 * (1 - shape), shape
