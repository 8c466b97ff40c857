"""The filter of an aircraft's height, and the limit that follows it, against textbooks in NumPy: one joint update."""

import jax.numpy as jnp
import numpy as np
import pytest

from laws.walk import walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Residual, Score, Trust
from sensorfault.core.verdicts import OK
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.height_kalman import HeightKalman
from sensorfault.stages.residual.multistep_observer import Bank
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.threshold.adaptive import Adaptive
from sensorfault.stages.threshold.fixed import Fixed

G = 9.80665
R, Q = np.array([0.04, 0.09, 0.25]), np.array([0.3, 0.01, 1e-4])
ROWS = np.array([[1.0, 0, 0, 0], [0, -1.0, 0, 0], [1.0, 0, 1.0, 0]])  # height, down, barometer


def flown(inertial: bool, seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Times and rows: height, down, barometer, pitch, roll and three axes of the specific force, each with holes."""
    random = np.random.default_rng(seed)
    time = np.cumsum(random.uniform(0.05, 0.15, 200))
    climb = 3 * np.sin(0.5 * time)
    height = 200 - 6 * np.cos(0.5 * time)
    pitch, roll = 0.2 * np.sin(time), 0.3 * np.cos(0.7 * time)
    up = 1.5 * np.cos(0.5 * time) + G
    force = up[:, None] * np.column_stack([np.sin(pitch), -np.sin(roll) * np.cos(pitch), -np.cos(roll) * np.cos(pitch)])
    value = np.column_stack([height, -climb, height - 50, pitch, roll, force])
    value[:, 7] += 0.1
    value += random.normal(size=value.shape) * [0.2, 0.3, 0.5, 1e-3, 1e-3, 0.1, 0.1, 0.1]
    value[random.random(value.shape) < 0.1] = np.nan
    value[60:63, 0] = np.nan
    if not inertial:
        value[:, 3:] = 0.0
    return time, value


def textbook(time, value, inertial: bool):
    """Innovation of the height and its variance at each row, NaN where there was nothing to test."""
    x, p, push, felt, taken, before, received = None, None, 0.0, False, 0, 0.0, 0.0
    for t, row in zip(time, value, strict=True):
        result = np.nan, np.nan
        z = row[:3]
        if x is not None and t - received > 2.0:
            x, taken = None, 0
        if x is not None:
            dt = t - before
            on = float(felt)
            f = np.array([[1, dt, 0, -on * dt**2 / 2], [0, 1, 0, -on * dt], [0, 0, 1, 0], [0, 0, 0, 1.0]])
            q = 4.0 if inertial and not felt else Q[0]
            noise = np.zeros((4, 4))
            noise[:2, :2] = q * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
            noise[2, 2], noise[3, 3] = Q[1] * dt, Q[2] * dt
            x = f @ x + push * np.array([dt**2 / 2, dt, 0, 0])
            p = f @ p @ f.T + noise
            there = np.isfinite(z)
            h = ROWS[there]
            s = h @ p @ h.T + np.diag(R[there])
            if there[0] and taken >= 5:
                result = z[0] - x[0], p[0, 0] + R[0]
            k = p @ h.T @ np.linalg.inv(s)
            x, p = x + k @ (z[there] - h @ x), p - k @ h @ p
            taken += there[0]
        elif np.isfinite(z[0]):
            x, taken = np.array([z[0], 0, 0, 0]), 1
            p = np.diag([R[0], 25.0, 90000.0, 0.09 if inertial else 0.0])
        if np.isfinite(z[0]):
            received = t
        felt = inertial and bool(np.isfinite(row[3:]).all())
        push = 0.0
        if felt:
            pitch, roll, fx, fy, fz = row[3:]
            body = np.array([np.sin(pitch), -np.sin(roll) * np.cos(pitch), -np.cos(roll) * np.cos(pitch)])
            push = float(body @ [fx, fy, fz]) - G
        before = t
        yield result


@pytest.mark.parametrize(("inertial", "below"), [(False, 1.0), (True, 1.0), (True, -1.0)])
def test_innovation_and_its_variance(inertial: bool, below: float) -> None:
    time, value = flown(inertial)
    want = np.array(list(textbook(time + np.where(np.arange(200) < 120, 0.0, 5.0), value, inertial)))
    value[:, 6:] *= below  # as an instrument says it whose y points left and z up
    time[120:] += 5.0  # longer than it goes without a height
    filter = HeightKalman(
        rows=jnp.asarray(ROWS),
        q=jnp.asarray(Q),
        r=jnp.asarray(R),
        gap_s=jnp.asarray(2.0),
        below=jnp.asarray(below),
        outputs=(0, 1, 2),
        inertial=(3, 4, 5, 6, 7) if inertial else (),
    )
    monitor = Monitor(
        filter, (Branch(Absolute(), Fixed(jnp.full(8, jnp.inf))),), Exceed(), Drop(), jnp.zeros(8), tuple(range(8))
    )
    result = walk(monitor, samples(time, value, np.isfinite(value)))
    tested = np.isfinite(want[:, 0])
    assert tested[20:120].mean() > 0.8
    residual = result.reports.residual
    np.testing.assert_array_equal(result.channel[:, 0] == OK, tested)
    np.testing.assert_allclose(residual.value[tested, 0], want[tested, 0], rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(residual.cov[tested, 0, 0], want[tested, 1], rtol=1e-7)
    late = tested & (np.arange(200) > 60)
    assert np.abs(want[late, 0] / np.sqrt(want[late, 1])).mean() < 1.5


def seen(s: float, score: float, valid: bool = True) -> tuple[Residual, Score]:
    nothing, yes = jnp.zeros(2), jnp.ones(2, bool)
    companion = Residual(jnp.zeros(()), nothing, jnp.diag(jnp.asarray([1.0, s])), nothing, nothing, nothing, yes, ~yes)
    bank = companion._replace(extra=Bank(jnp.asarray([score]), yes[:1]))
    both = companion._replace(cov=jnp.eye(2), extra=(bank, companion))
    return both, Score(jnp.asarray([score]), jnp.asarray([valid]), yes[None], jnp.ones((1, 2)))


def test_the_limit_follows_the_filter_and_what_was_believed_before() -> None:
    """T = a √(χ² S) + b E; E ends five measurements ago, and what is not believed or not tested is not in it."""
    random = np.random.default_rng(4)
    part = Adaptive(*(jnp.asarray([x]) for x in (1.5, 2.0, 0.7)), jnp.asarray(6.6), part=1, column=1, window=4, lag=3)
    state, kept = part.init(), [0.7] * 6
    for k in range(40):
        s, score = random.uniform(0.1, 2), random.normal()
        believed, valid = bool(k % 7), bool(k % 5)
        limit, pending = part.evaluate(state, seen(s, score, valid))
        error = np.sqrt(np.mean(np.square(kept[-6:-2])))
        assert float(limit[0]) == pytest.approx(1.5 * np.sqrt(6.6 * s) + 2.0 * error, rel=1e-12)
        learn = jnp.asarray([True, believed])
        state = part.update(pending, Trust(jnp.zeros(2), learn, ~learn, learn, ~learn))
        if believed and valid:
            kept.append(score)
