"""The motion deficit and the velocity deficit against plain NumPy, on a simulated drive."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log
from sensorfault.runtime.runners import replay, samples
from sensorfault.simulation.road import drive
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.motion_deficit import MotionDeficit
from sensorfault.stages.residual.velocity_deficit import VelocityDeficit
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.vehicles.inertial import Inertial

PATHS = ["gnss.latitude", "gnss.longitude", "gnss.speed", "gnss.course"]
SPACING_S, SLOTS = 0.15, 12
HORIZONS_S = np.array([0.3, 1.0])


@cache
def log() -> Log:
    axes = [f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz"]
    return drive(60.0, seed=5).log.select([*PATHS, *axes])


def told_by(residual, rows: Log):
    """The residual generator's own words on every sample, all trusted."""
    channels = len(rows.channels)
    branch = Branch(Norm(jnp.ones(channels)), Fixed(jnp.full(1, jnp.inf)))
    monitor = Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(channels), tuple(range(channels)))
    _, residuals = replay(
        monitor, monitor.init(), samples(rows.time, rows.value, rows.fresh), lambda report: report.residual
    )
    return jax.tree.map(np.asarray, residuals)


def metres(latitude: np.ndarray, longitude: np.ndarray) -> np.ndarray:
    """East, north, up of points on the ellipsoid from the first of them, by earth-centred coordinates (WGS-84)."""
    a, f = 6378137.0, 1 / 298.257223563
    n = a / np.sqrt(1 - f * (2 - f) * np.sin(latitude) ** 2)
    x, y = n * np.cos(latitude) * np.cos(longitude), n * np.cos(latitude) * np.sin(longitude)
    away = np.stack([x, y, n * (1 - f) ** 2 * np.sin(latitude)], axis=1)
    away = away - away[0]
    (sp, cp), (sl, cl) = ((np.sin(angle[0]), np.cos(angle[0])) for angle in (latitude, longitude))
    return away @ np.array([[-sl, cl, 0], [-sp * cl, -sp * sl, cp], [cp * cl, cp * sl, sp]]).T


def test_the_deficit_is_way_minus_displacement() -> None:
    rows = log()
    part = MotionDeficit(
        law=jnp.asarray([[0.5, 0.1, 0.01, 0.2]] * 2),
        horizon_s=jnp.asarray(HORIZONS_S),
        spacing_s=jnp.asarray(SPACING_S),
        afresh_s=jnp.asarray(30.0),
        inertial=None,
        position=(0, 1),
        velocity=(2, 3),
        polar=True,
        channels=len(rows.channels),
        slots=SLOTS,
    )
    result = told_by(part, rows).extra

    at = np.flatnonzero(rows.fresh[:, 0])
    time, (latitude, longitude, speed, course) = rows.time[at], rows.value[at][:, :4].T
    velocity = speed[:, None] * np.stack([np.sin(course), np.cos(course)], axis=1)
    dt = np.diff(time)[:, None]
    way = np.concatenate([np.zeros((1, 2)), np.cumsum((velocity[1:] + velocity[:-1]) / 2 * dt, axis=0)])
    path = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * dt[:, 0])])
    references: list[int] = []
    for i, now in enumerate(time):
        for h, horizon in enumerate(HORIZONS_S):
            old = [r for r in references if now - time[r] >= horizon - 1e-9]
            assert result.ready[at[i], h] == bool(old)
            if old:
                r = max(old)
                gone = metres(latitude[[r, i]], longitude[[r, i]])[1, :2]
                deficit = (way[i] - way[r]) - gone
                swing = np.linalg.norm(velocity[i] - velocity[r])
                terms = [1.0, swing**2, (path[i] - path[r]) ** 2, (now - time[r]) ** 2]
                assert result.age[at[i], h] == pytest.approx(now - time[r], abs=1e-9)
                np.testing.assert_allclose(result.deficit[at[i], h], deficit, atol=1e-4)
                assert result.path[at[i], h] == pytest.approx(path[i] - path[r], abs=1e-6)
                assert result.sigma[at[i], h] == pytest.approx(np.sqrt(np.dot([0.5, 0.1, 0.01, 0.2], terms)), rel=1e-6)
        if not references or now - time[references[-1]] >= SPACING_S - 1e-9:
            references = [*references, i][-SLOTS:]


def unit() -> Inertial:
    return Inertial(
        yaw=jnp.asarray([0.0, 0.0, -1.0]),
        push=jnp.asarray([0.9, 0.0, 0.0]),
        gyro_bias=jnp.asarray([0.0, 0.0, 0.01]),
        force_bias=jnp.zeros(3),
        lag_s=jnp.asarray([0.5, 0.0]),
        gyro=(4, 5, 6),
        accelerometer=(7, 8, 9),
    )


def test_the_slip_is_velocity_minus_what_the_unit_makes_of_it() -> None:
    rows, memory = log(), 4.0
    part = VelocityDeficit(jnp.asarray(memory), jnp.asarray(8.0), jnp.ones(2), unit(), (2, 3), True, len(rows.channels))
    result = told_by(part, rows).extra
    by_unit, rates = np.zeros(2), np.zeros(2)
    before = received = slow = -1e12
    for k, now in enumerate(rows.time):
        dt = np.clip(now - before, 0.0, 1.0)
        if k and now - received > 1.0:
            slow = now
        angle, speed = rates[0] * dt, np.linalg.norm(by_unit)
        turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) @ by_unit
        by_unit = turned * (max(speed + rates[1] * dt, 0.0) / speed if speed > 0.1 else 1.0)
        new = np.array([-(rows.value[k, 6] - 0.01), 0.9 * rows.value[k, 7]])
        # course rate lags by half a second, speed rate not at all
        rates = np.array([new[0] + (rates[0] - new[0]) * np.exp(-dt / 0.5), new[1]])
        before = now
        if not rows.fresh[k, 2]:
            assert not result.ready[k]
            continue
        velocity = rows.value[k, 2] * np.array([np.sin(rows.value[k, 3]), np.cos(rows.value[k, 3])])
        ahead = by_unit / max(np.linalg.norm(by_unit), 0.1)
        ready = now - slow >= memory / 4 and np.linalg.norm(by_unit) >= 3.0
        assert result.ready[k] == ready
        if ready:
            off = velocity - by_unit
            across = off[0] * ahead[1] - off[1] * ahead[0]
            np.testing.assert_allclose(result.slip[k], [off @ ahead, across], atol=1e-9)
        if rows.value[k, 2] < 3.0 or now - received > 8.0:
            by_unit, slow = velocity, now
        else:
            by_unit = by_unit + (1 - np.exp(-min(now - received, 1.0) / memory)) * (velocity - by_unit)
        received = now
    assert result.ready.sum() > 100
