import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sensorfault.numerics import geodesy

latitudes = st.floats(-np.pi / 2, np.pi / 2)
longitudes = st.floats(-np.pi, np.pi)
heights = st.floats(-10e3, 36e6)


def test_points_whose_place_is_known() -> None:
    a, b = 6378137.0, 6356752.314245179  # WGS-84 semi-axes, NGA.STND.0036
    point = geodesy.geodetic_to_ecef(*np.array([[0.0, 0.0, np.pi / 2], [0.0, np.pi / 2, 0.3], [0.0, 100.0, 20.0]]))
    np.testing.assert_allclose(point, [[a, 0, 0], [0, a + 100, 0], [0, 0, b + 20]], atol=1e-8)
    # IGS station WTZR (Wettzell): ITRF coordinates, and the geodetic ones of its site log.
    wettzell = np.array([4075580.3, 931853.9, 4801568.2])
    lat, lon, h = geodesy.ecef_to_geodetic(wettzell)
    assert np.rad2deg([lat, lon]) == pytest.approx([49.1442, 12.8789], abs=1e-4)
    assert float(h) == pytest.approx(666.0, abs=1.0)


def test_radii_are_those_of_the_ellipse() -> None:
    # From the ellipse itself: x = a cos β, z = b sin β; the meridian's radius is ds/dφ, the other x / cos φ.
    a, b = 6378137.0, 6356752.314245179
    beta = np.linspace(-1.4, 1.4, 200_001)
    lat = np.arctan2(a * np.sin(beta), b * np.cos(beta))
    speed = np.hypot(a * np.sin(beta), b * np.cos(beta))
    radius = speed / np.gradient(lat, beta)
    np.testing.assert_allclose(geodesy.meridian_radius(lat)[1:-1], radius[1:-1], rtol=1e-7)
    np.testing.assert_allclose(geodesy.transverse_radius(lat), a * np.cos(beta) / np.cos(lat), rtol=1e-12)


@given(latitudes, longitudes, heights)
def test_there_and_back(latitude: float, longitude: float, height: float) -> None:
    point = geodesy.geodetic_to_ecef(latitude, longitude, height)
    lat, lon, h = geodesy.ecef_to_geodetic(point)
    assert abs(lat - latitude) < 1e-11
    assert abs(h - height) < 1e-6
    if abs(latitude) < 1.57:
        assert abs(np.angle(np.exp(1j * (lon - longitude)))) < 1e-11


@given(latitudes, longitudes)
def test_local_axes_are_right_handed_and_up_is_the_way_height_grows(latitude: float, longitude: float) -> None:
    axes = geodesy.enu_axes(latitude, longitude)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(np.cross(axes[0], axes[1]), axes[2], atol=1e-14)
    rise = geodesy.geodetic_to_ecef(latitude, longitude, 1000.0) - geodesy.geodetic_to_ecef(latitude, longitude, 0.0)
    np.testing.assert_allclose(rise / 1000, axes[2], atol=1e-11)


def test_small_steps_are_radius_times_angle() -> None:
    origin, step = (0.9, 0.2, 150.0), 1e-6
    point = geodesy.geodetic_to_ecef(np.array([0.9 + step, 0.9]), np.array([0.2, 0.2 + step]), 150.0)
    # dn = (M + h) dφ,  de = (N + h) cos φ dλ; M and N at 0.9 rad from the textbook formulas.
    e2, s = 0.00669437999014, np.sin(0.9)
    n = 6378137.0 / np.sqrt(1 - e2 * s**2)
    m = 6378137.0 * (1 - e2) / (1 - e2 * s**2) ** 1.5
    local = geodesy.ecef_to_enu(point, *origin)
    np.testing.assert_allclose(local[0], [0, (m + 150) * step, 0], atol=1e-5)
    np.testing.assert_allclose(local[1], [(n + 150) * np.cos(0.9) * step, 0, 0], atol=1e-5)


def test_local_and_back() -> None:
    local = np.random.default_rng(0).normal(scale=1e4, size=(4, 5, 3))
    origin = (-0.7, 2.9, 30.0)
    np.testing.assert_allclose(geodesy.ecef_to_enu(geodesy.enu_to_ecef(local, *origin), *origin), local, atol=1e-8)
