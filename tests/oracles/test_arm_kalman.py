"""The arm's filter against a textbook's in NumPy: its own arm, Jacobians by differences, one joint update."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from laws.walk import walk
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.methods.arm.arm_kalman import arm_kalman
from sensorfault.runtime.runners import samples
from sensorfault.simulation.arm import AS_PRINTED, PERIOD_S, run

A1, A2, A3, A4, A5 = AS_PRINTED.constants


def step(x: np.ndarray, u: np.ndarray, dt: float) -> np.ndarray:
    """M q'' + h + g = u, solved as it stands."""
    cross = A3 + A2 * np.cos(x[3]) / 2
    mass = np.array([[A1 + A2 * np.cos(x[3]), cross], [cross, A3]])
    bend = A2 * np.sin(x[3]) / 2
    whirl = np.array([-bend * (2 * x[0] * x[1] + x[1] ** 2), bend * x[0] ** 2])
    weight = np.array([A4 * np.cos(x[2]) + A5 * np.cos(x[2] + x[3]), A5 * np.cos(x[2] + x[3])])
    return x + dt * np.concatenate([np.linalg.solve(mass, u - whirl - weight), x[:2]])


def textbook(time, value, q, r, limit) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Mean, covariance and verdicts of the four sensors, from the first row on."""
    x, p, u, known = value[0, :4], np.diag([1.0, 1.0, 0.01, 0.01]), value[0, 4:], True
    settled = False
    for before, t, z in zip(time, time[1:], value[1:], strict=False):
        dt = t - before
        f = np.stack([(step(x + 1e-6 * e, u, dt) - step(x - 1e-6 * e, u, dt)) / 2e-6 for e in np.eye(4)], axis=1)
        unsure = 0.0 if known else (100.0 * dt) ** 2
        x, p = step(x, u, dt), f @ p @ f.T + np.diag(q * dt + unsure * np.array([1, 1, 0, 0]))
        s = p + np.diag(r)
        settled = settled or bool((np.diag(s) <= 4 * r).all())
        over = np.abs(z[:4] - x) / np.sqrt(np.diag(s)) > limit  # a NaN is not
        there = np.isfinite(z[:4])
        good = there & ~(over & settled)
        h = np.eye(4)[good]
        k = p @ h.T @ np.linalg.inv(h @ s @ h.T)
        x, p = x + k @ (z[:4][good] - x[good]), p - k @ h @ p
        known = bool(np.isfinite(z[4:]).all())
        u = np.where(np.isfinite(z[4:]), z[4:], u)
        yield x, p, np.where(there & settled, np.where(over, FAULT, OK), UNKNOWN)


def test_filter_and_verdicts() -> None:
    log = run(seed=5, samples=300)
    value = log.value.copy()
    value[80:120, 1] += 0.5
    value[90:110, 3] += 0.03 * np.arange(20)
    value[150:170, 0] = np.nan
    value[200:203] = np.nan
    value[240:245, 5] = np.nan
    lying = replace(log, value=value, fresh=np.isfinite(value))
    monitor = arm_kalman("arm-kalman", log).monitor
    result = walk(monitor, samples(lying.time, lying.value, lying.fresh))
    q, r = np.asarray(monitor.residual.q), np.asarray(monitor.residual.r)
    limit = float(monitor.branches[0].threshold.limit[0])
    want = zip(*textbook(PERIOD_S * np.arange(300), value, q, r, limit), strict=True)
    mean, cov, verdict = (np.stack(x) for x in want)
    np.testing.assert_array_equal(result.channel[1:, :4], verdict)
    assert (verdict[79:119, 1] == FAULT).all()
    assert (verdict[95:109, 3] == FAULT).all()
    assert (verdict == FAULT)[:, [0, 2]].mean() < 0.01
    np.testing.assert_allclose(result.states.residual.mean[1:], mean, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(result.states.residual.cov[1:], cov, rtol=1e-4, atol=1e-11)
    assert (result.channel[0] == UNKNOWN).all()
