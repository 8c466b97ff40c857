"""The cubature filter against its textbook form in NumPy, with Cholesky roots and plain covariances."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.numerics.cubature import bent, correct, observe, predict, triangular
from sensorfault.numerics.geodesy import meridian_radius, transverse_radius


def _points(mean, cov):
    root = np.linalg.cholesky(cov)
    away = np.sqrt(len(mean)) * root
    return [mean + away[:, i] for i in range(len(mean))] + [mean - away[:, i] for i in range(len(mean))]


def _moments(at):
    mean = sum(at) / len(at)
    return mean, sum(np.outer(x - mean, x - mean) for x in at) / len(at)


def _filter(f, h, mean, cov, q, r, z, taken):
    """One round: prediction, points drawn anew, one joint update by what is taken."""
    mean, cov = _moments([f(x) for x in _points(mean, cov)])
    cov = cov + q
    at = _points(mean, cov)
    expected, s = _moments([h(x) for x in at])
    cross = sum(np.outer(x - mean, h(x) - expected) for x in at) / len(at)
    k = np.flatnonzero(taken)
    s = s[np.ix_(k, k)] + np.diag(r[k])
    gain = cross[:, k] @ np.linalg.inv(s)
    return mean + gain @ (z - expected)[k], cov - gain @ s @ gain.T


def _ours(f, h, mean, root, q_root, r, z, taken):
    mean, root = predict(f, mean, root, q_root)
    seen = observe(h, mean, root)
    return correct(mean, seen, z - seen.expected, r, taken)


def _turn(x, np=np):
    return np.stack(
        [x[0] + 0.1 * x[2] * np.cos(x[3]), x[1] + 0.1 * x[2] * np.sin(x[3]), 0.99 * x[2], x[3] + 0.1 * x[2] ** 2]
    )


def _ranges(x, np=np):
    return np.stack([np.sqrt((x[0] - a) ** 2 + (x[1] - b) ** 2) for a, b in ((3.0, 1.0), (-2.0, 5.0), (1.0, -4.0))])


def test_a_vehicle_that_turns_among_three_beacons() -> None:
    rng = np.random.default_rng(0)
    mean, cov = np.array([0.5, 0.2, 1.0, 0.3]), np.diag([0.3, 0.2, 0.1, 0.05]) + 0.02
    q, r = np.diag([0.01, 0.02, 0.01, 0.003]), np.array([0.04, 0.09, 0.2])
    ours = jnp.asarray(mean), jnp.asarray(np.linalg.cholesky(cov))
    step = jax.jit(
        lambda m, s, z, taken: _ours(
            lambda x: _turn(x, jnp), lambda x: _ranges(x, jnp), m, s, jnp.asarray(np.sqrt(q)), jnp.asarray(r), z, taken
        )
    )
    for _ in range(30):
        z, taken = _ranges(mean) + 0.2 * rng.standard_normal(3), rng.random(3) < 0.6
        mean, cov = _filter(_turn, _ranges, mean, cov, q, r, z, taken)
        ours = step(*ours, jnp.asarray(z), jnp.asarray(taken))
        np.testing.assert_allclose(ours[0], mean, rtol=1e-9)
        np.testing.assert_allclose(ours[1] @ ours[1].T, cov, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("spread_m", [0.03, 3.0])
def test_radians_are_as_good_as_metres(spread_m) -> None:
    """A position in radians with a spread of 3 cm goes on as the same one in metres does."""
    lat, lon = np.deg2rad([45.76, 126.63])
    scale = 1 / np.array([meridian_radius(lat), transverse_radius(lat) * np.cos(lat)])
    beacon, r = np.array([300.0, -200.0]), np.array([spread_m**2])
    metres = jnp.zeros(2), spread_m * jnp.eye(2)
    radians = jnp.asarray([lat, lon]), jnp.diag(jnp.asarray(spread_m * scale))
    origin, unit = jnp.asarray([lat, lon]), jnp.asarray(scale)

    def of_metres(x):
        return jnp.sqrt(((x - beacon) ** 2).sum())[None]

    still, q = lambda x: x, 0.3 * spread_m * jnp.eye(2)
    for k in range(200):
        z = of_metres(jnp.zeros(2)) + spread_m * np.sin(k)
        yes = jnp.ones(1, bool)
        metres = _ours(still, of_metres, *metres, q, jnp.asarray(r), z, yes)
        far = lambda x: of_metres((x - origin) / unit)  # noqa: E731
        radians = _ours(still, far, *radians, jnp.diag(unit) @ q, jnp.asarray(r), z, yes)
        assert (jnp.diag(radians[1]) > 0).all()
    np.testing.assert_allclose((radians[0] - origin) / unit, metres[0], atol=1e-5 * spread_m + 1e-7)
    np.testing.assert_allclose(radians[1] / unit[:, None], metres[1], rtol=1e-5)


def test_what_is_not_taken_changes_nothing() -> None:
    mean, root = jnp.asarray([0.5, 0.2, 1.0, 0.3]), 0.3 * jnp.eye(4) + 0.01 * jnp.tri(4, dtype=float)
    seen = observe(lambda x: _ranges(x, jnp), mean, root)
    wild = jnp.asarray([jnp.nan, 1e300, -5.0])
    after = correct(mean, seen, wild, jnp.ones(3), jnp.zeros(3, bool))
    np.testing.assert_array_equal(after[0], mean)
    np.testing.assert_allclose(after[1], root, rtol=1e-14, atol=1e-16)


@pytest.mark.parametrize("scale", [1.0, 1e-9, 1e-200])
def test_the_root_is_that_of_cholesky(scale) -> None:
    wide = np.random.default_rng(1).standard_normal((4, 9))
    np.testing.assert_allclose(
        triangular(jnp.asarray(scale * wide)) / scale, np.linalg.cholesky(wide @ wide.T), rtol=1e-10, atol=1e-12
    )


def test_a_spread_of_nothing_is_a_root_of_nothing() -> None:
    wide = np.array([[1.0, 2.0], [0.0, 0.0], [2.0, 4.0]])
    root = triangular(jnp.asarray(wide))
    np.testing.assert_allclose(root @ root.T, wide @ wide.T, atol=1e-12)


def test_what_bends_is_as_large_as_chance_makes_it() -> None:
    """h = x² / 2ρ + y has a curvature of 1 / ρ: of x = N(0, σ²) it makes a variance of (σ² / ρ)² / 2."""
    rho, sigma = 300.0, np.array([40.0, 3.0])

    def h(x):
        return jnp.stack([x[0] ** 2 / (2 * rho) + x[1]])

    mean = jnp.zeros(2)
    seen = observe(h, mean, jnp.diag(jnp.asarray(sigma)))
    drawn = np.random.default_rng(0).normal(0, sigma[0], 200_000) ** 2 / (2 * rho)
    np.testing.assert_allclose(bent(seen, h(mean)), [drawn.var()], rtol=0.02)
    straight = observe(lambda x: x[:1], mean, jnp.eye(2))
    np.testing.assert_allclose(bent(straight, jnp.zeros(1)), [0.0], atol=1e-20)
