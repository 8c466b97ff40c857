"""Short ways on the ellipsoid against the exact local frame."""

import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.numerics.geodesy import ecef_to_enu, geodetic_to_ecef
from sensorfault.numerics.local import east_north, moved, on_the_map, wrapped


@pytest.mark.parametrize("latitude", [-60.0, -1.0, 0.0, 51.05, 60.0])
@pytest.mark.parametrize("way", [(0.3, -0.7), (900.0, 1300.0), (-7000.0, 7000.0)])
@pytest.mark.parametrize("longitude", [13.7, 180.0, -179.99999])
def test_there_and_back(latitude: float, longitude: float, way: tuple[float, float]) -> None:
    lat, lon = jnp.asarray(np.deg2rad([latitude, longitude]))
    to = moved(lat, lon, jnp.asarray(way))
    np.testing.assert_allclose(east_north(to[0], to[1], lat, lon), way, atol=1e-6)
    # the plane touches the ellipsoid in the middle of the way, so that the way bends neither up nor sideways
    middle = np.asarray(moved(lat, lon, jnp.asarray(way) / 2))
    ends = [
        ecef_to_enu(geodetic_to_ecef(float(a), float(b), 0.0), float(middle[0]), float(middle[1]), 0.0)
        for a, b in ((lat, lon), to)
    ]
    np.testing.assert_allclose((ends[1] - ends[0])[:2], way, atol=0.01 if max(map(abs, way)) > 5e3 else 1e-4)


def test_no_east_at_the_poles_and_off_the_globe() -> None:
    here = jnp.asarray(0.5)
    for lat, lon in ((np.pi / 2, 0.3), (np.deg2rad(89.95), 1.0), (2.0, 0.0), (np.nan, 0.0), (0.0, np.inf)):
        assert not on_the_map(jnp.asarray(lat), jnp.asarray(lon))
        np.testing.assert_array_equal(east_north(jnp.asarray(lat), jnp.asarray(lon), here, here), 0.0)
    assert on_the_map(jnp.deg2rad(-89.8), jnp.asarray(np.pi))


def test_angles_are_wrapped() -> None:
    turns = np.array([-np.pi, np.pi, 3.5 * np.pi, -0.1, 100.0])
    back = np.asarray(wrapped(jnp.asarray(turns)))
    np.testing.assert_allclose(np.exp(1j * back), np.exp(1j * turns), atol=1e-12)
    assert (back > -np.pi - 1e-12).all()
    assert (back <= np.pi).all()
