"""What can be found and what cannot, against the rates that draws of noise have."""

import numpy as np
import pytest
from scipy import stats

from sensorfault.numerics.integrity import detectable, detectable_alone, inert, noncentrality, protection

ALPHA, BETA, DRAWS, C = 1e-3, 0.2, 50_000, 5


def covariance(seed: int) -> np.ndarray:
    root = np.random.default_rng(seed).standard_normal((C, C)) + np.eye(C)
    return root @ root.T + np.eye(C)


def test_baardas_number() -> None:
    """Baarda 1968: 4.13 at 0.1 % and 80 %."""
    assert noncentrality(0.001, 0.2) == pytest.approx(4.132, abs=1e-3)


@pytest.mark.parametrize("absent", [(), (1, 3)])
def test_a_bias_of_that_size_is_missed_as_often_as_stated(absent: tuple[int, ...]) -> None:
    s, rng = covariance(1), np.random.default_rng(2)
    known = ~np.isin(np.arange(C), absent)
    delta = noncentrality(ALPHA, BETA)
    by_w, alone = detectable(s, known, delta), detectable_alone(s, known, delta)
    assert np.isinf(by_w[~known]).all()
    assert np.isinf(alone[~known]).all()
    noise = rng.multivariate_normal(np.zeros(C), s, DRAWS)
    inverse = np.linalg.inv(s[np.ix_(known, known)])
    for row, c in enumerate(np.flatnonzero(known)):
        z = noise + by_w[c] * (np.arange(C) == c)
        w = (z[:, known] @ inverse)[:, row] / np.sqrt(inverse[row, row])
        assert np.mean(np.abs(w) <= stats.norm.isf(ALPHA / 2)) == pytest.approx(BETA, abs=0.008)
        own = (noise[:, c] + alone[c]) / np.sqrt(s[c, c])
        assert np.mean(np.abs(own) <= stats.norm.isf(ALPHA / 2)) == pytest.approx(BETA, abs=0.008)
        assert by_w[c] <= alone[c]


def test_a_lost_filter_has_inert_gates() -> None:
    known = np.array([True] * (C - 1) + [False])
    sharp, lost = (detectable_alone(np.eye(C) * sigma**2, known, 4.13) for sigma in (3.0, 50.0))
    np.testing.assert_array_equal(inert(sharp, 40.0), [False] * (C - 1) + [True])
    assert inert(lost, 40.0).all()


def filtered(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """One update of a plane position and a clock from C ranges: gain, S, P after, prior and H."""
    rng = np.random.default_rng(seed)
    bearing = rng.uniform(0, 2 * np.pi, C)
    h = np.column_stack([np.sin(bearing), np.cos(bearing), np.ones(C)])
    prior, r = np.diag([16.0, 9.0, 100.0]), np.diag(rng.uniform(1.0, 9.0, C))
    s = h @ prior @ h.T + r
    gain = prior @ h.T @ np.linalg.inv(s)
    return gain, s, (np.eye(3) - gain @ h) @ prior, prior, h


def test_no_unnoticed_fault_takes_the_position_beyond_its_level_more_often_than_the_risk() -> None:
    """Of every range in turn the bias that is worst for the level: missed, and the position off by more than it."""
    risk = 0.01
    gain, s, after, prior, h = filtered(3)
    mdb = detectable(s, np.ones(C, bool), noncentrality(ALPHA, risk))
    result = protection(gain[:2], after[:2, :2], mdb, risk)
    rng = np.random.default_rng(4)
    truth = rng.multivariate_normal(np.zeros(3), prior, DRAWS)
    noise = rng.standard_normal((DRAWS, C)) * np.sqrt(np.diag(s - h @ prior @ h.T))
    inverse = np.linalg.inv(s)
    z = truth @ h.T + noise
    off = np.hypot(*(z @ gain.T - truth)[:, :2].T)
    assert np.mean(off > result.fault_free) <= risk
    for c in range(C):
        for times in (0.8, 1.0):
            biased = z + times * mdb[c] * (np.arange(C) == c)
            w = np.abs(biased @ inverse) / np.sqrt(np.diag(inverse))
            unnoticed = w.max(axis=1) <= stats.norm.isf(ALPHA / 2)
            off = np.hypot(*(biased @ gain.T - truth)[:, :2].T)
            assert np.mean(unnoticed & (off > result.faulty)) <= risk
    assert result.worst == np.argmax(np.hypot(*gain[:2]) * mdb)
    assert result.faulty > result.fault_free


def test_what_is_not_taken_in_misleads_nobody() -> None:
    gain, s, after, *_ = filtered(5)
    known = np.arange(C) != 2
    result = protection(gain[:2] * known, after[:2, :2], detectable(s, known, 5.0), 1e-7)
    assert np.isfinite(result.faulty)
    assert result.worst != 2
    sigma = np.sqrt(np.linalg.eigvalsh(after[:2, :2])[-1])
    assert result.fault_free == pytest.approx(stats.rayleigh.isf(1e-7) * sigma)
