"""Logistic regression against scikit-learn's, and what it cannot be learned from."""

import jax
import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression

from sensorfault.logs.table import LogError
from sensorfault.training.logistic import fit_logistic


def rows(count: int = 150) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(6)
    features = np.exp(rng.standard_normal((count, 3)) + np.array([0.0, 1, 3]))
    return features, features[:, 0] + 0.3 * rng.standard_normal(count) > 2.5


@pytest.mark.parametrize("log", [True, False])
@pytest.mark.parametrize("c", [0.1, 1.0, 100.0])
def test_it_is_scikit_learns(log: bool, c: float) -> None:
    features, off = rows()
    result = jax.tree.map(np.asarray, fit_logistic(features, off, log, c=c))
    size = np.log(np.maximum(features, 0.01 * np.median(features, axis=0))) if log else features
    x = (size - size.min(axis=0)) / np.ptp(size, axis=0)
    want = LogisticRegression(C=c, tol=1e-10, max_iter=10_000).fit(x, off)
    np.testing.assert_allclose(result.weights, want.coef_[0], rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(result(features), want.decision_function(x), rtol=1e-4, atol=1e-4)


def test_both_kinds_must_be_there() -> None:
    features, off = rows()
    for one, word in ((off & False, "none"), (off | True, "all")):
        with pytest.raises(LogError, match=f"^{word} of the 150"):
            fit_logistic(features, one)
    with pytest.raises(LogError, match="row 0"):
        fit_logistic(features * np.nan, off)


def test_one_anomaly_is_little_and_no_failure() -> None:
    features, _ = rows()
    one = np.arange(150) == features[:, 0].argmax()
    result = jax.tree.map(np.asarray, fit_logistic(features, one))(features)
    assert np.isfinite(result).all()
    assert result.argmax() == one.argmax()
