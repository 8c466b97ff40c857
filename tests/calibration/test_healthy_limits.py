"""Limits from healthy scores: a kernel density against SciPy's, and a quantile with the spread of its runs."""

import numpy as np
import pytest
from scipy.stats import gaussian_kde

from sensorfault.calibration.calibrated import calibrated, epochs
from sensorfault.calibration.density import density_limit, silverman


def factors(seed: int, n: int = 1000) -> np.ndarray:
    """Skewed like local outlier factors."""
    return 1 + np.random.default_rng(seed).gamma(1.5, 0.2, n)


@pytest.mark.parametrize("share", [0.01, 0.001])
def test_the_density_is_scipys(share: float) -> None:
    scores = factors(0)
    kernel = gaussian_kde(scores, "silverman")
    assert silverman(scores) == pytest.approx(np.sqrt(kernel.covariance[0, 0]), rel=1e-12)
    limit = density_limit(np.append(scores, np.nan), share)
    assert kernel.integrate_box_1d(limit, np.inf) == pytest.approx(share, rel=1e-6)


def test_a_density_of_nothing_limits_nothing() -> None:
    assert density_limit(np.full(5, np.nan), 0.01) == np.inf
    assert density_limit(np.ones(5), 0.01) == pytest.approx(1.0)


def test_the_quantile_is_passed_by_the_share_asked_for() -> None:
    runs = [np.random.default_rng(seed).standard_normal(200) for seed in range(100)]
    runs[0][::2] = np.nan
    result = calibrated(runs, 0.01, seed=1)
    pooled = np.concatenate(runs)
    assert np.nansum(pooled > result.limit) == int(0.01 * np.isfinite(pooled).sum())
    assert result.low < result.limit < result.high
    assert result == calibrated(runs, 0.01, seed=1)


def test_epochs_of_one_run_are_hardly_more_than_one() -> None:
    """Each run has a level of its own: an interval drawn by epochs would hold the truth far less often."""
    truth = np.quantile(np.random.default_rng(0).standard_normal(1_000_000) * np.sqrt(1.01), 0.9)
    held = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        level = rng.standard_normal(60)
        result = calibrated([x + 0.1 * rng.standard_normal(50) for x in level], 0.1, seed)
        held += result.low <= truth <= result.high
    assert 14 <= held <= 20


def test_nothing_tested_limits_nothing_and_few_epochs_give_their_largest() -> None:
    assert calibrated([np.full(3, np.nan)], 0.01, 0).limit == np.inf
    assert calibrated([], 0.01, 0).limit == np.inf
    assert calibrated([np.array([1.0, 3.0, 2.0])], 0.01, 0) == (3.0, 3.0, 3.0)


def test_an_epoch_has_its_largest_valid_score() -> None:
    scores = np.array([[1.0, 5.0], [2.0, 3.0], [1.0, 1.0]])
    valid = np.array([[True, False], [True, True], [False, False]])
    np.testing.assert_array_equal(epochs(scores, valid), [1.0, 3.0, np.nan])
