"""Gravity against Somigliana's closed form, which knows nothing of harmonics, and NumPy's against JAX's."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import numpy as np
import pytest

from sensorfault.numerics import geodesy
from sensorfault.numerics.gravity import gravity

LATITUDE = np.deg2rad([-90.0, -60.0, -33.0, 0.0, 12.0, 45.0, 52.5, 80.0])
LONGITUDE = np.deg2rad([0.0, 170.0, -70.0, 40.0, -179.0, 9.0, 13.4, 100.0])


def local(height: float) -> np.ndarray:
    there = geodesy.geodetic_to_ecef(LATITUDE, LONGITUDE, height)
    return np.einsum("nij,nj->ni", geodesy.enu_axes(LATITUDE, LONGITUDE), gravity(there))


def test_on_the_ellipsoid_it_is_somiglianas_and_plumb() -> None:
    # NGA.STND.0036 (2014), equation 4-1 and table 3.5
    s = np.sin(LATITUDE) ** 2
    normal = 9.7803253359 * (1 + 0.00193185265241 * s) / np.sqrt(1 - 0.00669437999014 * s)
    np.testing.assert_allclose(local(0.0)[:, 2], -normal, atol=1e-6)
    np.testing.assert_allclose(local(0.0)[:, :2], 0, atol=1e-6)


def test_height_takes_from_it() -> None:
    # Free-air gradient with its second-order term at 45 degrees: NGA.STND.0036, equation 4-3.
    a, f, m, h = 6378137.0, 1 / 298.257223563, 0.00344978650684, 5000.0
    factor = 1 - 2 / a * (1 + f + m - 2 * f * np.sin(LATITUDE) ** 2) * h + 3 / a**2 * h**2
    size = np.linalg.norm(local(h), axis=1)
    np.testing.assert_allclose(size, -local(0.0)[:, 2] * factor, atol=2e-6)


def test_jax_says_the_same() -> None:
    there = geodesy.geodetic_to_ecef(LATITUDE, LONGITUDE, 120.0)
    np.testing.assert_allclose(jax.jit(gravity)(jax.numpy.asarray(there)), gravity(there), rtol=1e-14)
    assert gravity(there[0]) == pytest.approx(gravity(there)[0], rel=1e-15)
