"""The side force and its low pass against a loop in plain NumPy, with gaps, silences and distrust."""

import jax.numpy as jnp
import numpy as np

from laws.walk import walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.runtime.model import MOTION
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.side_force import SideForce
from sensorfault.stages.statistic.lasting import Lasting
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.vehicles.inertial import SideOn

ROWS, TICK, T, STALE = 400, 0.02, 0.3, 0.5
LEFT, LEVEL = np.array([0.1, 0.9, -0.2]), 0.3
UP, DRIFT, GAIN = np.array([0.05, -0.1, 0.98]), 0.01, 0.9


def log() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, values of gyro, accelerometer and velocity north and east, and which are new."""
    random = np.random.default_rng(5)
    time = np.arange(ROWS) * TICK
    time[150:] += 0.2  # the low pass survives it
    time[290:] += 0.8  # ... not this
    value = np.concatenate([random.normal(0, 0.3, (ROWS, 3)), random.normal(0, 2, (ROWS, 3))], axis=1)
    north, east = 8 + 6 * np.sin(time), np.cos(time)  # below 15 km/h for a while
    value = np.column_stack([value, north, east])
    fresh = np.ones(value.shape, bool)
    fresh[:, 6:] = (np.arange(ROWS) % 5 == 0)[:, None]
    value[60:63, 1] = np.nan
    fresh[220:260, 6:] = False  # the receiver is silent
    return time, value, fresh & np.isfinite(value)


def expected() -> np.ndarray:
    time, value, fresh = log()
    out = np.full(ROWS, np.nan)
    speed, received, y, last, since = 0.0, -np.inf, 0.0, -np.inf, -np.inf
    for t in range(ROWS):
        if fresh[t, :6].all() and time[t] - received <= STALE and speed >= 15 / 3.6:
            e = LEFT @ value[t, 3:6] - LEVEL - GAIN * speed * (UP @ value[t, :3] - DRIFT)
            dt = time[t] - last
            if dt > T:
                y, since = e, time[t]
            else:
                y += (1 - np.exp(-dt / T)) * (e - y)
            last = time[t]
            if time[t] - since >= 4 * T:
                out[t] = abs(y)
        if fresh[t, 6]:
            speed, received = np.hypot(value[t, 6], value[t, 7]), time[t]
    return out


def test_score_of_the_loop() -> None:
    time, value, fresh = log()
    unit = SideOn(jnp.asarray(LEFT), jnp.asarray(LEVEL), jnp.asarray(UP), jnp.asarray(DRIFT), (0, 1, 2), (3, 4, 5))
    residual = SideForce(unit, jnp.asarray(GAIN), jnp.asarray(STALE), (6, 7), False, 8)
    branch = Branch(Lasting(jnp.asarray(T), jnp.ones(8, bool)), Fixed(jnp.array([jnp.inf])), subject=MOTION)
    monitor = Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(8), (0, 0, 0, 1, 1, 1, 2, 2))
    result = walk(monitor, samples(time, value, fresh)).reports.scores[0]
    score = np.where(result.valid[:, 0], result.value[:, 0], np.nan)
    want = expected()
    assert 100 < np.isfinite(want).sum() < 350
    np.testing.assert_allclose(score, want, rtol=1e-10)
