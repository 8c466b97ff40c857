"""The bicycle's filter against a textbook's in NumPy: its own model, a Jacobian by differences, one joint update."""

from collections.abc import Iterator
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.core.types import Trust
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.bicycle_kalman import BicycleKalman, Columns

HZ, EVERY = 50.0, 5
LATE = 0.1, 0.25


def filter_of(polar: bool, steered: bool = False, **changed) -> BicycleKalman:
    """Channels: latitude, longitude, then speed or north and east, then acceleration x y z, then the turn."""
    wide = 1 if polar else 2
    first = 2 + wide
    fields = {
        "columns": Columns(
            position=(0, 1),
            velocity=tuple(range(2, first)),
            accelerometer=(first, first + 1, first + 2),
            gyro=() if steered else (first + 3, first + 4, first + 5),
            steering=(first + 3,) if steered else (),
        ),
        "forward": jnp.asarray([0.8, 0.0, 0.1]),
        "turning": jnp.asarray([0.07]) if steered else jnp.asarray([0.0, 0.1, 0.99]),
        "wheelbase": jnp.asarray(2.7),
        "q": jnp.asarray([1e-3, 1e-3, 1e-4, 1e-2, 1e-8, 1e-3]),
        "r": jnp.asarray([0.02, 0.01] + [0.03] * wide),
        "spread": jnp.asarray([1.2, 0.9] + [1.1] * wide),
        "smooth_s": jnp.asarray(0.2),
        "late_s": jnp.asarray(LATE),
        "speed_scale": jnp.asarray(1.02),
        "bias": jnp.asarray([0.002, 0.1]),
        "bias_spread": jnp.asarray([0.005, 0.3]),
        "channels": first + (4 if steered else 6),
    }
    return BicycleKalman(**(fields | changed))


def a_drive(polar: bool, steered: bool = False, seconds: float = 40.0, home=(0.89, 0.24), seed: int = 0):
    """Time, values (degrees of truth plus noise) and which are fresh, of a car that winds its way."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * HZ)) / HZ
    acceleration = 0.5 * np.cos(time / 3)
    speed = 8 + np.cumsum(acceleration) / HZ
    rate = 0.3 * np.sin(time / 4)
    heading = 0.5 + np.cumsum(rate) / HZ
    x, y = (np.cumsum(speed * f(heading)) / HZ + 0.05 * rng.standard_normal(len(time)) for f in (np.cos, np.sin))
    curve = SEMI_MAJOR_AXIS * (1 - 0.00669 * np.sin(home[0]) ** 2) ** -0.5
    place = np.stack([home[0] + y / curve / 0.9959, home[1] + x / curve / np.cos(home[0])], axis=1)
    said = speed * 1.02 + 0.1 * rng.standard_normal(len(time))
    velocity = said[:, None] if polar else np.stack([said * np.sin(heading), said * np.cos(heading)], axis=1)
    force = np.stack([acceleration / 0.8, np.zeros(len(time)), np.zeros(len(time))], axis=1)
    force += 0.2 * rng.standard_normal(force.shape)
    turn = np.arctan(2.7 * rate / speed)[:, None] / 0.07 if steered else np.stack([0 * rate, 0 * rate, rate], axis=1)
    value = np.concatenate([place, velocity, force, turn], axis=1)
    fresh = np.ones(value.shape, bool)
    fresh[:, : 2 + velocity.shape[1]] = (np.arange(len(time)) % EVERY == 0)[:, None]
    return time, value, fresh


@cache
def _run():
    def one(filter, belief, sample):
        residual, work = filter.evaluate(belief, sample)
        nobody = sample.fresh & False
        return filter.update(work, Trust(sample.value, sample.fresh, nobody, sample.fresh, sample.born)), residual

    return jax.jit(lambda f, b, rows: jax.lax.scan(lambda b, s: (lambda n, r: (n, (n, r)))(*one(f, b, s)), b, rows)[1])


def run(filter: BicycleKalman, time, value, fresh, start=None):
    """The belief after every sample, and the residuals."""
    with jax.numpy_dtype_promotion("standard"):
        result = _run()(filter, start if start is not None else filter.init(), samples(time, value, fresh))
    return jax.tree.map(np.asarray, result)


def textbook(filter: BicycleKalman, belief, time, value, fresh, polar: bool, steered: bool) -> Iterator[tuple]:
    """From one belief on, row by row: innovation, its covariance, mean, covariance; one fixed home for the position."""
    mean, cov = np.array(belief.mean), np.array(belief.cov)
    home, before = np.array(belief.anchor), float(belief.time)
    inputs = np.array(belief.inputs)
    q, r, spread = (np.asarray(a) for a in (filter.q, filter.r, filter.spread))
    wide = 1 if polar else 2
    first = 2 + wide

    def ahead(x, dt, u):
        turn = u[1] - x[4]
        rate = x[3] * np.tan(turn) / 2.7 if steered else turn
        middle, speed = x[2] + rate * dt / 2, x[3] + (u[0] - x[5]) * dt / 2
        way = speed * dt * np.array([np.cos(middle), np.sin(middle)])
        return np.array([*(x[:2] + way), x[2] + rate * dt, x[3] + (u[0] - x[5]) * dt, x[4], x[5]])

    def h(x, u):
        place, motion = ahead(x, -LATE[0], u), ahead(x, -LATE[1], u)
        v = 1.02 * motion[3]
        moving = [v] if polar else [v * np.sin(motion[2]), v * np.cos(motion[2])]
        return np.array([place[0], place[1], *moving])

    def slope(f, x):
        columns = []
        for k in range(6):
            step = np.zeros(6)
            step[k] = 1e-5
            columns.append((f(x + step) - f(x - step)) / 2e-5)
        return np.stack(columns, axis=1)

    for t, z, new in zip(time, value, fresh, strict=True):
        dt, before = t - before, t
        f = slope(lambda x, dt=dt, u=inputs: ahead(x, dt, u), mean)
        mean, cov = ahead(mean, dt, inputs), f @ cov @ f.T + np.diag(q * dt)
        e, s = None, None
        if new[0]:
            big_h = slope(lambda x, u=inputs: h(x, u), mean)
            curve = SEMI_MAJOR_AXIS / np.sqrt(1 - 0.0066943799901413165 * np.sin((home[0] + z[0]) / 2) ** 2)
            east = curve * np.cos((home[0] + z[0]) / 2) * (z[1] - home[1])
            north = curve**3 * (1 - 0.0066943799901413165) / SEMI_MAJOR_AXIS**2 * (z[0] - home[0])
            innovation = np.array([east, north, *z[2:first]]) - h(mean, inputs)
            c, d = np.cos(mean[2]), np.sin(mean[2])
            turned = np.eye(2 + wide)
            turned[:2, :2] = [[c, d], [-d, c]]
            e, big_h = turned @ innovation, turned @ big_h
            s = big_h @ cov @ big_h.T + np.diag(r)
            k = cov @ big_h.T @ np.linalg.inv(s)
            mean, cov = mean + k @ e, cov - k @ s @ k.T
            s = spread[:, None] * s * spread[None]
        now = [np.array([0.8, 0.0, 0.1]) @ z[first : first + 3]]
        now.append(0.07 * z[first + 3] if steered else np.array([0.0, 0.1, 0.99]) @ z[first + 3 : first + 6])
        keep = 0.2 / (0.2 + dt)
        inputs = keep * inputs + (1 - keep) * np.array(now)
        yield e, s, mean, cov, turned if new[0] else None


@pytest.mark.parametrize(("polar", "steered"), [(True, False), (False, False), (True, True)])
def test_against_the_textbook(polar: bool, steered: bool) -> None:
    filter = filter_of(polar, steered)
    time, value, fresh = a_drive(polar, steered)
    beliefs, residual = run(filter, time, value, fresh)
    start = int(np.flatnonzero(beliefs.alive)[0])
    assert start < 50
    begun = jax.tree.map(lambda x: x[start], beliefs)
    after = slice(start + 1, None)
    result = textbook(filter, begun, time[after], value[after], fresh[after], polar, steered)
    compared = 0
    for row, (e, s, mean, cov, turned) in enumerate(result, start + 1):
        # the textbook's metres count from one home, the filter's from the last fix: a part in 10^5 apart
        np.testing.assert_allclose(beliefs.mean[row][2:], mean[2:], rtol=1e-4, atol=1e-4)
        np.testing.assert_allclose(beliefs.cov[row], cov, rtol=1e-3, atol=1e-6)
        if e is not None:
            compared += 1
            at = (1, 0, *range(2, len(e)))  # east is the longitude
            np.testing.assert_allclose(residual.value[row, list(at)][2:], (turned.T @ e)[2:], rtol=1e-3, atol=1e-4)
            here = value[row, :2]
            unit = np.array([1 / (np.cos(here[0]) * 6.388e6), 1 / 6.374e6])
            np.testing.assert_allclose(residual.value[row, [1, 0]] / unit, (turned.T @ e)[:2], rtol=5e-3, atol=1e-3)
            whitened = np.sqrt(e @ np.linalg.solve(s, e))
            mine = list(range(len(e)))
            v, c = residual.value[row, mine], residual.cov[row][np.ix_(mine, mine)]
            size = np.sqrt(np.diag(c))
            again = np.sqrt(v / size @ np.linalg.solve(c / np.outer(size, size), v / size))
            assert again == pytest.approx(whitened, rel=2e-3, abs=1e-3)
    assert compared > 300


def test_its_jacobian_is_that_of_the_model() -> None:
    filter = filter_of(polar=True)
    x, u, dt = jnp.asarray([3.0, -2.0, 0.7, 9.0, 0.01, 0.2]), jnp.asarray([0.5, 0.3]), jnp.asarray(0.02)
    found = np.asarray(jax.jacfwd(filter.ahead)(x, u, dt))
    for k in range(6):
        step = jnp.eye(6)[k] * 1e-6
        slope = (np.asarray(filter.ahead(x + step, u, dt)) - np.asarray(filter.ahead(x - step, u, dt))) / 2e-6
        np.testing.assert_allclose(found[:, k], slope, atol=1e-8)


def test_home_does_not_matter() -> None:
    """Across the date line and near a pole the whitened innovations are what they are anywhere."""
    filter = filter_of(polar=True)
    sizes = []
    for home in ((0.4, 0.24), (0.4, np.pi - 1e-6)):
        time, value, fresh = a_drive(True, home=home)
        value[:, 1] = (value[:, 1] + np.pi) % (2 * np.pi) - np.pi
        _, residual = run(filter, time, value, fresh)
        sizes.append((residual.value / np.sqrt(np.diagonal(residual.cov, axis1=1, axis2=2)))[residual.valid])
    np.testing.assert_allclose(sizes[0], sizes[1], atol=1e-4)


def test_nothing_is_known_at_a_pole() -> None:
    time, value, fresh = a_drive(True)
    value[:, 0] = np.pi / 2 - 1e-4
    beliefs, residual = run(filter_of(polar=True), time, value, fresh)
    assert not residual.valid.any()
    assert not beliefs.alive.any()
    assert all(np.isfinite(x).all() for x in jax.tree.leaves(beliefs))


def test_it_starts_afresh_after_a_gap_and_without_fixes() -> None:
    time, value, fresh = a_drive(True, seconds=60.0)
    filter = filter_of(polar=True)
    later = time + np.where(time > 20, 30.0, 0.0)
    beliefs, _ = run(filter, later, value, fresh)
    gone = np.flatnonzero(~beliefs.alive & (time > 20))
    assert gone[0] == np.flatnonzero(time > 20)[0]
    assert gone.size < 1.0 * HZ  # until the first two metres are gone
    held = fresh.copy()
    held[(time > 20) & (time < 35), :3] = False
    beliefs, residual = run(filter, time, value, held)
    gone = time[~beliefs.alive & (time > 20)]
    assert 29.9 < gone[0] < 30.1
    assert gone[-1] < 35.6
    assert residual.valid[(time > 36) & fresh[:, 0], :3].all()


def test_a_car_at_rest_keeps_its_heading() -> None:
    """Ten minutes at a light, with a gyro that drifts: the heading is that of the way there."""
    time, value, fresh = a_drive(True, seconds=20.0)
    rest = 30000
    time = np.concatenate([time, time[-1] + np.arange(1, rest + 1) / HZ])
    still = np.repeat(value[-1:], rest, axis=0)
    still[:, 2] = 0.0
    still[:, 3:] = [0.125, 0.0, 0.0, 0.0, 0.0, 0.01]  # what the accelerometer says of no acceleration
    brake = np.arange(rest) < 200
    speed, heading = value[-1, 2] / 1.02, 0.5 + 0.3 / HZ * np.sin(time[:1000] / 4).sum()
    still[brake, 3] = -speed / 4 / 0.8 + 0.125
    still[brake, 2] = 1.02 * speed * (1 - np.arange(200) / 200)
    way = np.cumsum(np.where(brake, speed * (1 - np.arange(rest) / 200), 0.0)) / HZ
    still[:, 0] += way * np.sin(heading) / 6.374e6
    still[:, 1] += way * np.cos(heading) / 6.388e6 / np.cos(value[-1, 0])
    new = np.concatenate([fresh, np.tile(fresh[:5], (rest // 5, 1))])
    beliefs, _ = run(filter_of(polar=True), time, np.concatenate([value, still]), new)
    settled = len(value) + 1000
    assert beliefs.alive[-1]
    assert abs(beliefs.mean[-1, 2] - beliefs.mean[settled, 2]) < 0.02
    assert abs(beliefs.mean[-1, 3]) < 0.2
    assert np.linalg.eigvalsh(beliefs.cov[-1]).min() > 0
    assert np.sqrt(beliefs.cov[-1, 2, 2]) < 0.5
