"""Tests for slow drifts against loops over the very samples in the window."""

from collections.abc import Callable, Iterator

import jax.numpy as jnp
import numpy as np
import pytest
from scipy import stats

from laws.strict import strict
from oracles.drifting import SIGMA, Log, scores
from sensorfault.stages.statistic.averaged_innovation import AveragedInnovation
from sensorfault.stages.statistic.cusum import Cusum
from sensorfault.stages.statistic.ewma import Ewma
from sensorfault.stages.statistic.mean_pair import MeanPair
from sensorfault.stages.statistic.ramp_glr import LEAST, RampGlr
from sensorfault.stages.statistic.slope import Slope
from sensorfault.stages.statistic.windowed import Measure, Windowed
from sensorfault.stages.statistic.windowed_chi_square import WindowedChiSquare

__all__ = ["strict"]

WINDOW_S, GAP_S, SHARE = 40.0, 8.0, 0.3


def windowed(measure: Measure, slots: int = 64) -> Windowed:
    return Windowed(measure, jnp.asarray(WINDOW_S), jnp.asarray(GAP_S), 2, slots)


def slope(t: np.ndarray, y: np.ndarray, sigma: float) -> float:
    return abs(np.polyfit(t, y, 1)[0])


def mean_pair(t: np.ndarray, y: np.ndarray, sigma: float) -> float:
    age, part = t[-1] - t, SHARE * WINDOW_S
    return abs(y[age < part].mean() - y[age > WINDOW_S - part].mean())


def ramp_glr(t: np.ndarray, y: np.ndarray, sigma: float) -> float:
    """Twice the log likelihood ratio is the sum of squares that a ramp takes away, over the variance."""
    alone = ((y - y.mean()) ** 2).sum()
    left = [alone]
    for j in range(len(t) - LEAST):
        design = np.column_stack([np.ones(len(t)), np.maximum(t - t[j], 0.0)])
        left.append(((y - design @ np.linalg.lstsq(design, y, rcond=None)[0]) ** 2).sum())
    return np.sqrt(max(alone - one for one in left)) / sigma


def averaged(t: np.ndarray, y: np.ndarray, sigma: float) -> float:
    information = sum(1 / sigma**2 for _ in y)
    mean = sum(one / sigma**2 for one in y) / information
    return abs(mean) * np.sqrt(information)


def chi_square(t: np.ndarray, y: np.ndarray, sigma: float) -> float:
    q = sum((one / sigma) ** 2 for one in y)
    return max(np.sqrt(2 * q) - np.sqrt(2 * len(y) - 1), 0.0)


MEASURES = {
    "slope": (Slope(), slope),
    "mean-pair": (MeanPair(jnp.asarray(SHARE)), mean_pair),
    "ramp-glr": (RampGlr(), ramp_glr),
    "averaged": (AveragedInnovation(), averaged),
    "chi-square": (WindowedChiSquare(), chi_square),
}


def runs(log: Log, c: int) -> Iterator[tuple[int, np.ndarray]]:
    """Each valid row with the rows of its window, which a gap begins anew; only where the window is full."""
    rows = log.seen(c, len(log.time) - 1)
    begun = rows[0]
    for last, k in zip(np.insert(rows[:-1], 0, rows[0]), rows, strict=True):
        if log.time[k] - log.time[last] > GAP_S:
            begun = k
        mine = rows[(rows >= begun) & (rows <= k) & (log.time[rows] >= log.time[k] - WINDOW_S)]
        if log.time[k] - log.time[begun] >= WINDOW_S:
            yield k, mine


@pytest.mark.parametrize("gap_s", [0.0, 20.0])
@pytest.mark.parametrize("name", MEASURES)
def test_each_window_is_as_a_loop_says(name: str, gap_s: float) -> None:
    measure, oracle = MEASURES[name]
    log = Log(3, gap_s=gap_s)
    result = scores(windowed(measure), log)
    for c in range(2):
        judged = list(runs(log, c))
        assert len(judged) > 40
        for k, mine in judged:
            np.testing.assert_allclose(result[k, c], oracle(log.time[mine], log.value[mine, c], SIGMA[c]), rtol=1e-9)
        assert np.isnan(result[~log.valid[:, c], c]).all()
    if gap_s:
        gap = len(log.time) // 3 + 1
        assert np.isnan(result[gap : gap + 25]).all()


@pytest.mark.parametrize("name", MEASURES)
def test_a_fast_channel_shares_slots(name: str) -> None:
    """20 values a second, a few seconds a slot: nearly what a loop over all of them says."""
    measure, oracle = MEASURES[name]
    log = Log(4, rows=2000, holes=0.0)
    log.time = np.arange(2000) / 20.0
    ramp = 0.1 * np.maximum(log.time - 60.0, 0.0)[:, None] * SIGMA
    log.value = np.random.default_rng(4).standard_normal((2000, 2)) * SIGMA + ramp
    result = scores(windowed(measure, 40), log)
    for k in (1000, 1500, 1999):
        t = log.time[: k + 1]
        mine = np.flatnonzero(t >= t[-1] - WINDOW_S)
        expected = oracle(log.time[mine], log.value[mine, 0], SIGMA[0])
        np.testing.assert_allclose(result[k, 0], expected, rtol=0.1, atol=0.02 if name == "slope" else 0.5)


def test_hours_and_unix_time_cost_no_digits() -> None:
    log = Log(5, rows=400)
    late = Log(5, rows=400)
    late.time = late.time + 1.7e9
    for measure, _ in MEASURES.values():
        np.testing.assert_allclose(scores(windowed(measure), late), scores(windowed(measure), log), rtol=1e-4)


def test_white_noise_is_standard_normal() -> None:
    log = Log(6, rows=3000, holes=0.0)
    log.value = np.random.default_rng(6).standard_normal((3000, 2)) * SIGMA
    result = scores(windowed(AveragedInnovation()), log)[100::40]
    assert stats.kstest(result[np.isfinite(result)], "halfnorm").pvalue > 0.01
    square = scores(windowed(WindowedChiSquare()), log)[100::40]
    assert np.mean(square > 1.645) == pytest.approx(0.05, abs=0.04)


def cusum_loop(log: Log, c: int, k: float, ceiling: float) -> np.ndarray:
    up = down = 0.0
    last, result = -np.inf, np.full(len(log.time), np.nan)
    for row in log.seen(c, len(log.time) - 1):
        if log.time[row] - last > GAP_S:
            up = down = 0.0
        e = log.value[row, c] / SIGMA[c]
        up, down = min(max(up + e - k, 0.0), ceiling), min(max(down - e - k, 0.0), ceiling)
        result[row], last = max(up, down), log.time[row]
    return result


def ewma_loop(log: Log, c: int, memory_s: float) -> np.ndarray:
    """Weights of all values since it began, one by one."""
    result = np.full(len(log.time), np.nan)
    rows, begun, last = [], -np.inf, -np.inf
    for row in log.seen(c, len(log.time) - 1):
        if log.time[row] - last > GAP_S:
            rows, begun = [], row
        rows.append(row)
        t = log.time[rows]
        gain = np.append(1.0, 1 - np.exp(-np.diff(t) / memory_s))
        weight = np.array([gain[i] * np.prod(1 - gain[i + 1 :]) for i in range(len(rows))])
        result[row] = abs(weight @ (log.value[rows, c] / SIGMA[c])) / np.sqrt((weight**2).sum())
        last = log.time[row]
    assert begun >= 0
    return result


@pytest.mark.parametrize("gap_s", [0.0, 20.0])
@pytest.mark.parametrize(
    ("part", "loop"),
    [
        (Cusum(jnp.full(2, 0.5), jnp.full(2, 30.0), jnp.asarray(GAP_S)), lambda log, c: cusum_loop(log, c, 0.5, 30.0)),
        (Ewma(jnp.full(2, 12.0), jnp.asarray(GAP_S)), lambda log, c: ewma_loop(log, c, 12.0)),
    ],
    ids=["cusum", "ewma"],
)
def test_sums_and_averages_are_as_a_loop_says(part, loop: Callable[[Log, int], np.ndarray], gap_s: float) -> None:
    log = Log(7, gap_s=gap_s)
    result = scores(part, log)
    for c in range(2):
        np.testing.assert_allclose(result[:, c], loop(log, c), rtol=1e-9)
    assert np.nanmax(result) > 10
