"""A Kalman filter that drops what it does not believe, from the textbook, against the guest in the monitor."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from laws.damage import lied, silenced
from laws.guests.zoo import R3, Q, log, position_log, three_positions
from laws.walk import walk
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN

LIMIT = 4.0
SPREAD = np.array([1.0, 10.0])  # a vague belief would cost the textbook's covariance update its digits


def textbook(time, value, limit):
    """One row of H, R and the innovation for each channel that is there and believed; no masks, no Joseph form."""
    x, p, before = np.zeros(2), np.diag(SPREAD**2), time[0]
    for t, z in zip(time, value, strict=True):
        dt, before = t - before, t
        f = np.array([[1, dt], [0, 1]])
        x, p = f @ x, f @ p @ f.T + Q * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
        score = np.abs(z - x[0]) / np.sqrt(p[0, 0] + R3)
        good = np.flatnonzero(score <= limit)  # a NaN is not
        h, r = np.tile([1.0, 0.0], (good.size, 1)), np.diag(R3[good])
        k = p @ h.T @ np.linalg.inv(h @ p @ h.T + r)
        x, p = x + k @ (z[good] - h @ x), p - k @ h @ p
        yield x, p, np.where(np.isnan(z), UNKNOWN, np.where(score > limit, FAULT, OK))


def test_kalman_with_drop() -> None:
    rows = log(position_log(21))
    rows = lied(rows, slice(100, 160), [0.0, 4.0, 0.0])
    rows = lied(rows, slice(180, 200), [-3.0, 0.0, 12.0])
    rows = silenced(rows, slice(220, 260), [0, 1])
    rows = silenced(rows, slice(300, 320))
    monitor = eqx.tree_at(lambda m: m.residual.spread, three_positions(limit=LIMIT, most=3), jnp.asarray(SPREAD))
    result = walk(monitor, rows)
    mean, cov, verdict = (np.stack(x) for x in zip(*textbook(rows.time, np.asarray(rows.value), LIMIT), strict=True))
    np.testing.assert_array_equal(result.channel, verdict)
    assert (verdict == FAULT).any(axis=0).all()
    np.testing.assert_allclose(result.states.residual.mean, mean, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(result.states.residual.cov, cov, rtol=1e-10, atol=1e-10)
