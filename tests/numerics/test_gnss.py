"""Satellites against the equations of motion, integrated by SciPy in a frame that does not turn; published figures."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from sensorfault.numerics import geodesy
from sensorfault.numerics.gnss import atmosphere, glonass, kepler, sight
from sensorfault.numerics.gnss.constellation import walker
from sensorfault.numerics.gnss.glonass import GlonassEphemeris
from sensorfault.numerics.gnss.kepler import Ephemeris

C, EARTH = 299792458.0, 7.2921151467e-5
MUNICH = np.deg2rad([48.1, 11.6])


def about_z(angle: float) -> np.ndarray:
    """Coordinates in a frame turned by so much about z."""
    return np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def one(**given: float) -> Ephemeris:
    """GPS's constants, zeros, and what is given."""
    plain = dict.fromkeys(Ephemeris._fields, 0.0) | {"mu": 3.986005e14, "earth_rate": EARTH, "sqrt_a": 5153.7}
    return Ephemeris(**{name: np.float64(value) for name, value in (plain | given).items()})


@pytest.mark.parametrize("eccentricity", [0.0, 0.012, 0.3])
def test_an_unperturbed_orbit_obeys_newton(eccentricity: float) -> None:
    result = {"eccentricity": eccentricity, "anomaly": 2.1, "node": -1.3, "inclination": 0.96, "perigee": 0.7}
    ephemeris = one(toe=1000.0, toe_of_week=500.0, **result)
    times = 1000.0 + np.array([0.0, 3000.0, 7200.0])
    # the frame that does not turn coincides with the earth's at the first time
    start, speed = kepler.position(ephemeris, times[0]), kepler.velocity(ephemeris, times[0])
    free = speed + np.cross([0, 0, EARTH], start)
    truth = solve_ivp(
        lambda t, y: np.concatenate((y[3:], -3.986005e14 * y[:3] / np.linalg.norm(y[:3]) ** 3)),
        (times[0], times[-1]),
        np.concatenate((start, free)),
        t_eval=times,
        rtol=1e-12,
        atol=1e-6,
    )
    expected = [about_z(EARTH * (t - times[0])) @ y[:3] for t, y in zip(times, truth.y.T, strict=True)]
    np.testing.assert_allclose(kepler.position(ephemeris, times), expected, atol=0.15)  # the start's speed: 1e-5 m/s
    # vis viva: v² = μ (2 / r - 1 / a)
    r = np.linalg.norm(start)
    assert free @ free == pytest.approx(3.986005e14 * (2 / r - 1 / 5153.7**2), rel=1e-9)


def test_a_geostationary_orbit_told_by_a_tilted_equator_stands_still() -> None:
    mu, rate, tilt = 3.986004418e14, 7.292115e-5, np.deg2rad(-5)
    radius = (mu / rate**2) ** (1 / 3)  # that of a sidereal day
    # the tilted equator rises by 5 degrees towards the true one's y, so that an orbit on the true one falls by as much
    result = {"mu": mu, "earth_rate": rate, "sqrt_a": radius**0.5, "tilt": tilt, "inclination": tilt, "anomaly": 1.9}
    times = np.array([0.0, 3600.0, 43200.0])
    place = radius * np.array([np.cos(1.9), np.sin(1.9), 0.0])
    np.testing.assert_allclose(kepler.position(one(**result), times), np.tile(place, (3, 1)), atol=1e-3)


def test_keplers_equation_is_solved() -> None:
    mean, eccentricity = np.meshgrid(np.linspace(-7, 7, 101), [0.0, 0.01, 0.1, 0.3])
    found = kepler.eccentric_anomaly(mean, eccentricity)
    np.testing.assert_allclose(found - eccentricity * np.sin(found), mean, atol=1e-13)


def test_harmonic_corrections_are_along_across_and_up() -> None:
    plain = one(perigee=0.4, inclination=0.9)
    start, speed = kepler.position(plain, np.float64(0.0)), kepler.velocity(one(perigee=0.4, inclination=0.9), 0.0)
    up = start / np.linalg.norm(start)
    sin, cos = np.sin(2 * 0.4), np.cos(2 * 0.4)
    higher = kepler.position(plain._replace(crs=np.float64(100.0), crc=np.float64(30.0)), np.float64(0.0)) - start
    np.testing.assert_allclose(higher, (100 * sin + 30 * cos) * up, atol=1e-6)
    ahead = kepler.position(plain._replace(cus=np.float64(1e-6), cuc=np.float64(2e-6)), np.float64(0.0)) - start
    assert np.linalg.norm(ahead) == pytest.approx(5153.7**2 * (1e-6 * sin + 2e-6 * cos), rel=1e-6)
    assert abs(ahead @ up) < 1e-3
    assert ahead @ speed > 0


def test_the_clock_has_its_polynomial_its_group_delay_and_the_swing_of_relativity() -> None:
    ephemeris = one(toc=100.0, af0=1e-4, af1=1e-11, af2=1e-17, group_delay=5e-9, eccentricity=0.02, anomaly=1.0)
    time = np.float64(100.0 + 3600)
    found = kepler.clock(ephemeris, time)
    # relativity by the other form of the textbooks: -2 r·v / c², in the frame that does not turn
    r = kepler.position(ephemeris, time)
    v = kepler.velocity(ephemeris, time) + np.cross([0, 0, EARTH], r)
    expected = 1e-4 + 1e-11 * 3600 + 1e-17 * 3600**2 - 5e-9 - 2 * (r @ v) / C**2
    assert found == pytest.approx(expected, abs=1e-14)


def test_glonass_obeys_the_pull_of_a_flattened_earth() -> None:
    mu, ae, j2, rate = 3.986004418e14, 6378136.0, 1.08262575e-3, 7.292115e-5
    place, speed = np.array([7003008.0, -12206626.0, 21280765.0]), np.array([783.54, 2804.23, 1352.51])
    state = GlonassEphemeris(np.float64(0), np.float64(1e-5), np.float64(1e-12), place, speed, np.zeros(3))

    def pull(_t: float, y: np.ndarray) -> np.ndarray:
        # a = -∇U, U = -μ/r (1 - J2 ae²/r² (3 z²/r² - 1) / 2), by differences
        def potential(p: np.ndarray) -> float:
            r = np.linalg.norm(p)
            return -mu / r * (1 - j2 * (ae / r) ** 2 * (3 * (p[2] / r) ** 2 - 1) / 2)

        slope = [(potential(y[:3] + d) - potential(y[:3] - d)) / 200 for d in 100 * np.eye(3)]
        return np.concatenate((y[3:], -np.array(slope)))

    free = speed + np.cross([0, 0, rate], place)
    truth = solve_ivp(pull, (0, 900.0), np.concatenate((place, free)), rtol=1e-11, atol=1e-6).y[:, -1]
    turn = about_z(rate * 900)
    found, moving = glonass.state(state, np.float64(900.0))
    np.testing.assert_allclose(found, turn @ truth[:3], atol=0.05)
    np.testing.assert_allclose(moving, turn @ truth[3:] - np.cross([0, 0, rate], found), atol=1e-4)
    assert glonass.clock(state, np.float64(900.0)) == pytest.approx(1e-5 + 9e-10, abs=1e-16)


def test_light_travels_in_a_frame_that_does_not_turn() -> None:
    receiver = geodesy.geodetic_to_ecef(*MUNICH, 500.0)
    satellites = kepler.position(walker(), np.float64(5000.0))

    def late(flight: float, satellite: np.ndarray) -> float:
        """How much longer the light is under way than that, in the frame of the time of arrival."""
        return float(np.linalg.norm(about_z(EARTH * flight) @ satellite - receiver)) - C * flight

    truth = [C * brentq(late, 0.01, 0.2, args=(satellite,), xtol=1e-18) for satellite in satellites]
    np.testing.assert_allclose(sight.distance(receiver, satellites), truth, atol=1e-5)
    straight = np.linalg.norm(satellites - receiver, axis=1)
    assert np.abs(truth - straight).max() > 20  # what it costs to leave it out [m]


def test_elevation_and_azimuth() -> None:
    receiver, axes = geodesy.geodetic_to_ecef(*MUNICH, 500.0), geodesy.enu_axes(*MUNICH)
    way = np.array([[0, 1, 0], [1, 0, 1], [0, -1, np.sqrt(3)], [-1, 0, -1.0]]) * 1e7
    elevation, azimuth = sight.elevation_azimuth(receiver, receiver + way @ axes, axes)
    np.testing.assert_allclose(np.rad2deg(elevation), [0, 45, 60, -45], atol=1e-9)
    np.testing.assert_allclose(np.rad2deg(azimuth), [0, 90, 180, 270], atol=1e-9)


def test_klobuchar_gives_the_published_example() -> None:
    # M. Mahooti, "Klobuchar ionospheric delay model" (GPS Toolbox): 23.784 m
    result = np.array([0.382e-7, 0.149e-7, -0.179e-6, 0.0, 0.143e6, 0.0, -0.328e6, 0.113e6])
    lat, lon, el, az = np.deg2rad([40.0, -100.0, 20.0, 210.0])
    assert atmosphere.klobuchar(result, lat, lon, el, az, 593100.0) == pytest.approx(23.784, abs=1e-3)
    night = atmosphere.klobuchar(result, lat, lon, np.pi / 2, az, 9 * 3600.0)
    assert night == pytest.approx(C * 5e-9, rel=1e-3)
    other = atmosphere.klobuchar(result, lat, lon, el, az, 593100.0, frequency=1176.45e6)
    assert other == pytest.approx(23.784 * (1575.42 / 1176.45) ** 2, rel=1e-4)


def test_the_troposphere_delays_by_two_metres_and_a_half_from_the_zenith() -> None:
    # zenith hydrostatic delay of Saastamoinen (1972) at 1013.25 hPa, 45 degrees: 2.307 m
    assert atmosphere.saastamoinen(np.pi / 4, 0.0, np.pi / 2, 0.0) == pytest.approx(2.307, abs=1e-3)
    wet = atmosphere.saastamoinen(np.pi / 4, 0.0, np.pi / 2) - 2.307
    assert 0.05 < wet < 0.2
    low = atmosphere.saastamoinen(np.pi / 4, 0.0, np.deg2rad(15.0))
    assert low == pytest.approx((2.307 + wet) / np.sin(np.deg2rad(15.0)), rel=1e-3)
    # at 5,574 m the standard atmosphere has 500 hPa
    high = atmosphere.saastamoinen(np.pi / 4, 5574.0, np.pi / 2, 0.0)
    assert high == pytest.approx(2.307 * 500 / 1013.25, rel=3e-3)


def test_a_low_satellite_is_trusted_less() -> None:
    sigma = sight.pseudorange_sigma(np.deg2rad([90.0, 30.0, 5.0, 1.0, -3.0]))
    np.testing.assert_allclose(sigma[:2], [np.sqrt(0.18), np.sqrt(0.09 + 0.36)], rtol=1e-12)
    assert sigma[2] < sigma[3] * 1.01
    assert sigma[3] == sigma[4]


def test_a_constellation_as_that_of_gps() -> None:
    places = kepler.position(walker(), np.linspace(0, 86164, 50)[:, None])
    np.testing.assert_allclose(np.linalg.norm(places, axis=-1), 26_559_700.0, rtol=1e-9)
    np.testing.assert_allclose(places[-1], places[0], atol=5e4)  # a sidereal day later the sky is the same
    apart = np.linalg.norm(places[0][:, None] - places[0], axis=-1) + 1e9 * np.eye(36)
    assert apart.min() > 2e6
    receiver, axes = geodesy.geodetic_to_ecef(*MUNICH, 0.0), geodesy.enu_axes(*MUNICH)
    elevation, _ = sight.elevation_azimuth(receiver, places, axes)
    seen = (elevation > np.deg2rad(10)).sum(axis=1)
    assert 7 <= seen.min() <= seen.max() <= 16
    with pytest.raises(ValueError, match="evenly"):
        walker(35)


def test_the_same_under_jit_vmap_and_grad() -> None:
    receiver, axes = geodesy.geodetic_to_ecef(*MUNICH, 500.0), geodesy.enu_axes(*MUNICH)
    sky = walker()
    result = jax.tree.map(jnp.asarray, sky)

    def all_of_it(r: jax.Array, time: jax.Array) -> tuple[jax.Array, ...]:
        place = kepler.position(result, time)
        el, az = sight.elevation_azimuth(r, place, jnp.asarray(axes))
        air = atmosphere.saastamoinen(MUNICH[0], 500.0, el)
        ion = atmosphere.klobuchar(jnp.full(8, 1e-8), *MUNICH, el, az, time)
        return place, kepler.clock(result, time), sight.distance(r, place), el, air, ion, sight.pseudorange_sigma(el)

    place = kepler.position(sky, np.float64(300.0))
    el, az = sight.elevation_azimuth(receiver, place, axes)
    plain = (
        place,
        kepler.clock(sky, np.float64(300.0)),
        sight.distance(receiver, place),
        el,
        atmosphere.saastamoinen(MUNICH[0], 500.0, el),
        atmosphere.klobuchar(np.full(8, 1e-8), *MUNICH, el, az, 300.0),
        sight.pseudorange_sigma(el),
    )
    many = jax.jit(jax.vmap(all_of_it))(jnp.stack([jnp.asarray(receiver)] * 2), jnp.full(2, 300.0))
    for ours, theirs in zip(many, plain, strict=True):
        np.testing.assert_allclose(ours[1], theirs, rtol=1e-11, atol=1e-6)
    slope = jax.jacfwd(lambda r: sight.distance(r, place))(jnp.asarray(receiver))
    unit = (receiver - place) / np.linalg.norm(receiver - place, axis=1, keepdims=True)
    np.testing.assert_allclose(slope, unit, atol=1e-5)
