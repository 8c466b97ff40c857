"""Conditioning and the Mahalanobis test against joint Gaussians by brute force, in plain NumPy."""

import jax.numpy as jnp
import numpy as np
import pytest

from laws.guests.zoo import log
from laws.walk import walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Residual
from sensorfault.numerics.gaussian import precision
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.conditioning import Conditioning
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.conditioning import fit_conditioning
from sensorfault.training.unbroken import unbroken

CHANNELS, LAGS, TICK = 4, 3, 0.02
EACH = np.ones(CHANNELS, bool)


def drive(length: int, seed: int = 0) -> np.ndarray:
    """A stable vector autoregression with common noise, in units from 0.01 to 100."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((CHANNELS, CHANNELS)))[0]
    noise = rng.standard_normal((length, CHANNELS)) @ np.random.default_rng(2).standard_normal((CHANNELS, CHANNELS))
    x = np.zeros((length, CHANNELS))
    for t in range(2, length):
        x[t] = 0.5 * turn @ x[t - 1] + 0.3 * x[t - 2] + noise[t]
    return x * [0.01, 1, 10, 100] + [0, 9.8, 0, -500]


def time(length: int) -> np.ndarray:
    return np.arange(length) * TICK


def conditional(train: np.ndarray, past: np.ndarray, now: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance of the newest row given the LAGS before it, from the stacked rows' sample covariance."""
    stacked = np.array([train[t - LAGS : t + 1].ravel() for t in range(LAGS, len(train))])
    mean, s = np.tile(train.mean(axis=0), LAGS + 1), np.cov(stacked.T, bias=True)
    k = CHANNELS * LAGS
    gain = s[k:, :k] @ np.linalg.pinv(s[:k, :k], rcond=1e-15)
    expected = np.array([mean[k:] + gain @ (row - mean[:k]) for row in past])
    return now - expected, s[k:, k:] - gain @ s[:k, k:]


def monitor(residual: Conditioning, *statistics: Mahalanobis) -> Monitor:
    branches = tuple(Branch(statistic, Fixed(jnp.array([jnp.inf]))) for statistic in statistics)
    return Monitor(residual, branches, Exceed(), Drop(), jnp.zeros(CHANNELS), tuple(range(CHANNELS)))


def test_residual_score_and_blame_are_those_of_the_joint_gaussian() -> None:
    train, unseen = drive(3000), drive(60, seed=9)
    fitted = fit_conditioning(time(3000), train, np.ones(3000, bool), EACH, LAGS, bound=np.inf)
    rows = log(unseen)._replace(time=time(60))
    result = walk(monitor(fitted, Mahalanobis(), Mahalanobis(single=True)), rows).reports
    past = [unseen[t - LAGS : t].ravel() for t in range(LAGS, 60)]
    errors, cov = conditional(train, np.array(past), unseen[LAGS:])
    scale = np.sqrt(np.outer(np.diag(cov), np.diag(cov)))
    np.testing.assert_allclose(fitted.cov / scale, cov / scale, atol=1e-3)
    for t, e in enumerate(errors[5:], start=LAGS + 5):
        np.testing.assert_allclose(
            result.residual.value[t] / np.sqrt(np.diag(cov)), e / np.sqrt(np.diag(cov)), atol=2e-3
        )
        s, e = np.asarray(fitted.cov), result.residual.value[t]
        distance = e @ np.linalg.solve(s, e)
        # Freeing channel k: what is left of the distance is that of the others alone.
        left = [
            np.delete(e, k) @ np.linalg.solve(np.delete(np.delete(s, k, 0), k, 1), np.delete(e, k)) for k in range(4)
        ]
        np.testing.assert_allclose(result.scores[0].value[t, 0], np.sqrt(distance), rtol=1e-9)
        np.testing.assert_allclose(result.scores[0].blame[t, 0], 1 - np.array(left) / distance, atol=1e-9)
        np.testing.assert_allclose(result.scores[1].value[t, 0], np.sqrt(distance - min(left)), rtol=1e-6)
        np.testing.assert_array_equal(result.scores[1].blame[t, 0], result.scores[0].blame[t, 0])


def test_without_levels_it_is_least_squares_on_the_changes() -> None:
    train = drive(3000) + np.cumsum(np.random.default_rng(4).standard_normal((3000, CHANNELS)), axis=0)
    fitted = fit_conditioning(time(3000), train, np.ones(3000, bool), EACH, LAGS, levels=False)
    change = np.diff(train, axis=0)
    past = np.array([np.concatenate([change[t - j] for j in range(1, LAGS)]) for t in range(LAGS, len(change))])
    b = np.linalg.lstsq(past, change[LAGS:], rcond=None)[0]
    want = np.cov((change[LAGS:] - past @ b).T, bias=True)
    scale = np.sqrt(np.outer(np.diag(want), np.diag(want)))
    np.testing.assert_allclose(fitted.cov / scale, want / scale, atol=1e-2)
    rows = np.array([train[t : t - LAGS : -1].ravel() for t in range(LAGS, 3000)]) - np.tile(fitted.center, LAGS)
    result = rows[:-1] @ np.asarray(fitted.weights).T + np.asarray(fitted.center)
    np.testing.assert_allclose((result - (train[LAGS:-1] + past @ b)) / np.sqrt(np.diag(want)), 0, atol=5e-2)


def test_without_levels_an_offset_moves_nobody_else() -> None:
    """What lasts is the channel's own: the weights of its rows add up to one on itself and to nothing on the others."""
    fitted = fit_conditioning(time(3000), drive(3000), np.ones(3000, bool), EACH, LAGS, levels=False)
    reach = np.asarray(fitted.weights).reshape(CHANNELS, LAGS, CHANNELS).sum(axis=1)
    np.testing.assert_allclose(reach / np.outer([0.01, 1, 10, 100], [100, 1, 0.1, 0.01]), np.eye(CHANNELS), atol=1e-9)


@pytest.mark.parametrize("known", [EACH, EACH & False, np.array([True, False, True, True]), np.arange(4) == 2])
def test_precision_is_the_inverse_of_what_is_known(known: np.ndarray) -> None:
    root = np.random.default_rng(3).standard_normal((CHANNELS, CHANNELS))
    cov = root @ root.T
    want = np.zeros((CHANNELS, CHANNELS))
    want[np.ix_(known, known)] = np.linalg.inv(cov[np.ix_(known, known)])
    np.testing.assert_allclose(precision(jnp.asarray(cov), jnp.asarray(known)), want, rtol=1e-9, atol=1e-12)


def test_a_channel_that_is_not_valid_is_marginalised_out() -> None:
    root = np.random.default_rng(4).standard_normal((CHANNELS, CHANNELS))
    cov, e, valid = root @ root.T, np.array([1.0, 50.0, -2.0, 0.5]), np.array([True, False, True, True])
    nothing = jnp.zeros(CHANNELS)
    seen = Residual(
        jnp.zeros(()), jnp.asarray(e), jnp.asarray(cov), nothing, nothing, nothing, jnp.asarray(valid), nothing > 0
    )
    score, _ = Mahalanobis().evaluate((), seen)
    want = np.sqrt(e[valid] @ np.linalg.solve(cov[np.ix_(valid, valid)], e[valid]))
    np.testing.assert_allclose(score.value[0], want, rtol=1e-10)
    assert float(score.blame[0, 1]) == 0
    np.testing.assert_array_equal(score.covers[0], valid)


def test_channels_that_follow_from_each_other() -> None:
    """A rank-deficient joint covariance: ridge keeps weights and precision finite and the twin found."""
    x = drive(2000)
    x[:, 3] = 2 * x[:, 1]
    fitted = fit_conditioning(time(2000), x, np.ones(2000, bool), EACH, LAGS)
    assert np.linalg.eigvalsh(fitted.cov / np.sqrt(np.outer(np.diag(fitted.cov), np.diag(fitted.cov)))).min() > 0
    x[500, 3] += x[:, 3].std()
    result = walk(monitor(fitted, Mahalanobis()), log(x[:600])._replace(time=time(600))).reports
    assert result.scores[0].value[500, 0] > 10 * result.scores[0].value[100:500].max()


def test_a_spike_too_small_to_be_named_stays_out_of_the_window() -> None:
    train, unseen = drive(3000), drive(200, seed=5)
    clean = fit_conditioning(time(3000), train, np.ones(3000, bool), EACH, LAGS)
    sigma = np.sqrt(np.diag(clean.cov))
    spiked = unseen.copy()
    spiked[100] += 20 * sigma
    result = walk(monitor(clean, Mahalanobis()), log(spiked)._replace(time=time(200)))
    assert np.abs((result.states.residual.rows[100, 0] - unseen[100]) / sigma).max() < 3 + 4
    open_ended = fit_conditioning(time(3000), train, np.ones(3000, bool), EACH, LAGS, bound=np.inf)
    taken = walk(monitor(open_ended, Mahalanobis()), log(spiked)._replace(time=time(200)))
    np.testing.assert_allclose(taken.states.residual.rows[100, 0], spiked[100])


def test_windows_with_a_hole_are_not_learned_from() -> None:
    at, complete = time(40), np.ones(40, bool)
    at[20:] += 1.0
    complete[30] = False
    want = [t for t in range(LAGS, 40) if not (20 <= t < 20 + LAGS or 30 <= t <= 30 + LAGS)]
    np.testing.assert_array_equal(np.flatnonzero(unbroken(at, complete, LAGS)), want)


def test_after_a_gap_one_value_fills_the_window_and_its_word_counts_for_less() -> None:
    train, unseen = drive(3000), drive(100, seed=6)
    fitted = fit_conditioning(time(3000), train, np.ones(3000, bool), EACH, LAGS)
    late = time(100) + np.where(np.arange(100) < 50, 0, 30.0)
    result = walk(monitor(fitted, Mahalanobis()), log(unseen)._replace(time=late))
    np.testing.assert_array_equal(result.states.residual.rows[50], np.tile(unseen[50], (LAGS, 1)))
    noise = np.asarray(result.reports.residual.noise)
    assert (noise[50] > noise[49]).all()
    np.testing.assert_allclose(noise[51], np.diag(fitted.cov), rtol=1e-9)
