"""The local outlier factor against scikit-learn's, and windowed means against loops over the very samples."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from sklearn.neighbors import LocalOutlierFactor

from laws.strict import strict
from oracles.drifting import SIGMA, Log, scores
from sensorfault.logs.table import LogError
from sensorfault.numerics.blocks import enough
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.stages.statistic.cumulative_bank import CumulativeBank
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.statistic.outlier_factor import OutlierFactor
from sensorfault.stages.statistic.windowed_outlier_factor import WindowedOutlierFactor
from sensorfault.training.outlier_factor import fit_history

__all__ = ["strict"]

LENGTHS, GAP_S, SPACING_S = (1.0, 10.0, 30.0), 8.0, 1.0
SPREAD = np.array([1.0, 0.5, 0.25])
factor = jax.jit(lambda history, asked: history.outlier_factor(asked))


def peer(points: np.ndarray, k: int, asked: np.ndarray) -> np.ndarray:
    return -LocalOutlierFactor(n_neighbors=k, novelty=True).fit(points).score_samples(asked)


@pytest.mark.parametrize("features", [1, 2, 3])
@pytest.mark.parametrize("k", [1, 20])
def test_equals_scikit_learn(features: int, k: int) -> None:
    rng = np.random.default_rng(features)
    points = rng.standard_t(4, (1000, features))
    asked = np.concatenate(
        [
            rng.standard_t(3, (500, features)),
            1e6 * rng.standard_normal((20, features)),  # far out, where all distances are alike
            points[:50],
            np.zeros((1, features)),
        ]
    )
    result = factor(fit_history(points, 0, k=k), asked)
    np.testing.assert_allclose(result, peer(points, k, asked), rtol=1e-6)
    assert result[500:520].min() > 100


@pytest.mark.parametrize("features", [1, 3])
def test_equal_points_are_treated_as_scikit_learn_does(features: int) -> None:
    """30 times the same point, more than k: their density is bounded, and a point among them is none of the others'."""
    rng = np.random.default_rng(9)
    points = np.concatenate([rng.standard_normal((200, features)), np.full((30, features), 0.25)])
    asked = np.concatenate([np.full((1, features), 0.25), rng.standard_normal((50, features))])
    np.testing.assert_allclose(factor(fit_history(points, 0), asked), peer(points, 20, asked), rtol=1e-6)


def test_between_two_clumps_far_apart_the_nearest_are_still_told_apart() -> None:
    rng = np.random.default_rng(10)
    points = rng.standard_normal((600, 3)) + 100 * rng.choice([-1.0, 1.0], (600, 1))
    asked = np.concatenate([10 * rng.standard_normal((200, 3)), points[:50] + 100])
    np.testing.assert_allclose(factor(fit_history(points, 0), asked), peer(points, 20, asked), rtol=1e-6)


@pytest.mark.parametrize("count", [21, 1024, 1500])
def test_histories_of_other_lengths(count: int) -> None:
    rng = np.random.default_rng(count)
    points, asked = rng.standard_normal((count, 3)), rng.standard_normal((50, 3))
    result = factor(fit_history(points, 0, history=count), asked)
    np.testing.assert_allclose(result, peer(points, 20, asked), rtol=1e-6)


@pytest.mark.parametrize("features", [1, 3])
def test_on_a_grid_exactly_k_of_those_equally_far_count(features: int) -> None:
    """Which of them is scikit-learn's secret, so the grid is one on which it makes no difference."""
    points = np.arange(40.0)[:, None] * np.ones(features)
    asked = np.array([[20.0], [19.5]]) * np.ones(features)
    np.testing.assert_allclose(factor(fit_history(points, 0, k=3), asked), peer(points, 3, asked), rtol=1e-6)


@pytest.mark.parametrize("features", [1, 3])
def test_of_what_is_no_number_nothing_is_told(features: int) -> None:
    """Nor is it infinitely far: where nothing is known nothing is blamed, and nothing cleared."""
    asked = np.full((2, features), 0.1)
    asked[0, -1] = np.nan
    result = np.asarray(factor(history(features), asked))
    assert np.isnan(result[0])
    assert np.isfinite(result[1])


def test_a_history_is_drawn_by_its_seed_and_knows_what_it_needs() -> None:
    rng = np.random.default_rng(1)
    seen = rng.standard_normal((3000, 1))
    seen[::3] = np.nan
    one, same, other = (fit_history(seen, seed, history=500) for seed in (3, 3, 4))
    assert one.points.shape == (1, 500)
    assert np.isin(one.points, seen).all()
    np.testing.assert_array_equal(one.points, same.points)
    assert not np.array_equal(one.points, other.points)
    with pytest.raises(LogError, match="20 healthy innovations are too few for 20 neighbours"):
        fit_history(seen[:30], 0)


def history(features: int) -> LocalDensity:
    return fit_history(np.random.default_rng(2).standard_t(5, (400, features)), 0)


@pytest.mark.parametrize("raw", [False, True])
def test_each_innovation_is_rated_alone(raw: bool) -> None:
    log = Log(11)
    result = scores(OutlierFactor(history(1), raw=raw), log)
    asked = log.value / (1 if raw else SIGMA)
    expected = peer(np.asarray(history(1).points).T, 20, asked.reshape(-1, 1)).reshape(-1, 2)
    np.testing.assert_allclose(result, np.where(log.valid, expected, np.nan), rtol=1e-6)


def means(spread: np.ndarray) -> Means:
    return Means(
        *(jnp.asarray(x) for x in (LENGTHS, spread, SPACING_S, GAP_S)), channels=2, slots=enough(30.0, SPACING_S)
    )


def mean_loop(log: Log, spread: np.ndarray) -> np.ndarray:
    """Of the values less old than each window, as many as it should hold; those lacking since it began count 0."""
    result = np.full((len(log.time), 2, len(LENGTHS)), np.nan)
    for c in range(2):
        rows, last = [], -np.inf
        for k in log.seen(c, len(log.time) - 1):
            t = log.time[k]
            rows, last = [*(rows if t - last <= GAP_S else []), k], t
            age = t - log.time[rows]
            for w, length in enumerate(LENGTHS):
                share = min(1.0, (t - log.time[rows[0]] + SPACING_S) / length)
                e = log.value[rows, c][age <= length - SPACING_S / 2] / SIGMA[c]
                result[k, c, w] = share * e.mean() / spread[w]
    return result


@pytest.mark.parametrize("gap_s", [0.0, 20.0])
def test_the_bank_is_as_a_loop_says(gap_s: float) -> None:
    log = Log(12, gap_s=gap_s)
    expected = np.abs(mean_loop(log, SPREAD)).max(axis=2)
    np.testing.assert_allclose(scores(CumulativeBank(means(SPREAD)), log), expected, rtol=1e-9)
    assert np.nanmax(expected) > 10


def test_the_windowed_factor_is_that_of_the_means() -> None:
    log = Log(13, gap_s=20.0)
    result = scores(WindowedOutlierFactor(history(3), means(SPREAD)), log)
    asked = mean_loop(log, SPREAD)[log.valid]
    np.testing.assert_allclose(result[log.valid], peer(np.asarray(history(3).points).T, 20, asked), rtol=1e-6)
    assert np.isnan(result[~log.valid]).all()
