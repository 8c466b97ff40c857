"""A train against a strapdown in an inertial frame, against the geometry of railways, and its satellites by hand."""

from functools import cache

import numpy as np
import pytest

from oracles.strapdown import navigate
from sensorfault.logs.satellites import satellites
from sensorfault.numerics.geodesy import ecef_to_enu, ecef_to_geodetic, enu_axes
from sensorfault.simulation import track, train
from sensorfault.simulation.felt import felt
from sensorfault.simulation.ride import Ride
from sensorfault.simulation.sky import Sky

DEGREE = np.pi / 180
BERLIN = (52.45 * DEGREE, 13.3 * DEGREE, 80.0)


@cache
def ride(seed: int, hz: int = 20, noise: str = "gaussian") -> Ride:
    return train.ride(600.0, seed, noise, imu_hz=hz)  # type: ignore[arg-type]


def local(one: Ride) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and body axes in the plane of the track: east, north, up."""
    axes = enu_axes(*BERLIN[:2])
    return one.velocity @ axes.T, axes @ one.attitude


def test_what_is_felt_leads_back_to_the_ride() -> None:
    one = ride(1)
    rate, force = felt(one.position, one.velocity, one.attitude, 0.05)
    place, velocity, attitude = navigate(rate[1:], force[1:], 0.05, one.position[0], one.velocity[0], one.attitude[0])
    assert np.linalg.norm(one.position[-1] - one.position[0]) > 5000
    assert np.linalg.norm(place - one.position[1:], axis=1).max() < 1.0
    assert np.linalg.norm(velocity - one.velocity[1:], axis=1).max() < 0.005
    assert np.abs(attitude - one.attitude[1:]).max() < 1e-8


def test_standing_it_feels_the_earth_turn_and_its_own_weight() -> None:
    one = ride(1)
    rate, force = felt(one.position, one.velocity, one.attitude, 0.05)
    assert np.linalg.norm(one.velocity[:400]) == 0.0
    # forward is east at the start: the earth's turn is to the left and up
    assert rate[10] == pytest.approx(7.2921151467e-5 * np.array([0, -np.cos(BERLIN[0]), -np.sin(BERLIN[0])]), abs=2e-6)
    assert np.linalg.norm(force[10]) == pytest.approx(9.8127, abs=2e-3)
    assert force[10, 2] < -9.8


@pytest.mark.parametrize("seed", range(4))
def test_it_goes_as_trains_go(seed: int) -> None:
    one = ride(seed)
    velocity, body = local(one)
    speed = np.linalg.norm(velocity, axis=1)
    assert speed.max() < 141 / 3.6
    assert speed.max() > 70 / 3.6
    assert 0.05 < (speed < 0.01).mean() < 0.5
    ahead = np.gradient(speed, 0.05)
    assert ahead.min() > -0.65
    assert ahead.max() < 0.55
    assert np.abs(np.gradient(ahead, 0.05)).max() < 0.4
    moving = speed > 5
    # it points where it goes, no steeper than 12.5 per mille, and the rails lean into the curve by 0.1 rad at most
    along = (body[:, :, 0] * velocity).sum(axis=1) / np.maximum(speed, 1e-9)
    assert (along[moving] > 0.9999).all()
    assert np.abs(velocity[moving, 2] / speed[moving]).max() < 0.0126
    lean = np.arcsin(-body[:, 2, 1])
    assert np.abs(lean).max() <= 0.1001
    turn = np.gradient(np.unwrap(np.arctan2(body[:, 0, 0], body[:, 1, 0])), 0.05)
    assert np.corrcoef(lean[moving], turn[moving])[0, 1] > 0.5
    # what the rails do not take up is left to the passengers
    assert np.abs(speed * turn - 9.81 * lean).max() < 0.98


def test_curves_are_eased_and_stations_lie_in_the_open() -> None:
    one = track.line(30_000.0, np.random.default_rng(3))
    route = one.route
    assert np.abs(route.curvature).max() < 1 / 590
    # over a transition of 120 m or more
    assert np.abs(np.diff(route.curvature)).max() / 0.5 < 1 / 600 / 60
    assert (route.curvature == 0).mean() > 0.2
    assert (one.cant * route.curvature <= 0).all()
    stations = np.flatnonzero(route.stop)
    assert 5 <= len(stations) <= 12
    assert np.diff(stations)[1:].min() * 0.5 > 2999
    for at in stations:
        assert not one.tunnel[at]
        assert one.left[at] == one.right[at] == 0
    assert 0.01 < one.tunnel.mean() < 0.3
    assert 0.1 < ((one.left > 0) | (one.right > 0)).mean() < 0.7
    assert one.left.max() <= 45 * DEGREE


def test_no_satellite_shines_through_the_ground() -> None:
    quarter = np.pi / 2
    azimuth = np.array([[0.0, quarter, 2 * quarter, 3 * quarter, 0.5 * quarter]])
    flat = np.zeros((1, 5))
    three = np.zeros((1, 5, 3))
    sky = Sky(("G01", "G02", "G03", "G04", "G05"), flat, flat, three, three, np.full((1, 5), 30 * DEGREE), azimuth)

    def seen(tunnel: bool, left: float, right: float, heading: float) -> list[bool]:
        ground = track.Track(
            track.line(1000.0, np.random.default_rng(0)).route,
            np.zeros(2000),
            np.full(2000, tunnel),
            np.full(2000, left),
            np.full(2000, right),
        )
        return list(train.visible(sky, np.array([heading]), ground, np.array([100.0]))[0])

    # northwards: east is on the right
    north = quarter
    assert seen(False, 0.0, 0.0, north) == [True] * 5
    assert seen(True, 0.0, 0.0, north) == [False] * 5
    assert seen(False, 0.0, 35 * DEGREE, north) == [True, False, True, True, True]
    assert seen(False, 35 * DEGREE, 0.0, north) == [True, True, True, False, True]
    # at 45 degrees off the track tan 45 sin 45 is still above tan 30
    assert seen(False, 0.0, 45 * DEGREE, north) == [True, False, True, True, False]
    # eastwards: south is on the right
    assert seen(False, 0.0, 35 * DEGREE, 0.0) == [True, True, False, True, True]


def test_the_log_tells_satellites_as_readers_do() -> None:
    one = ride(2)
    seen = satellites(one.log)
    at = one.epochs
    assert seen.names == one.sky.names
    np.testing.assert_array_equal(seen.usable[at], np.isfinite(one.error))
    assert not np.delete(seen.usable, at, axis=0).any()
    assert np.isfinite(one.error).sum(axis=1).min() < 6
    assert np.isfinite(one.error).sum(axis=1).max() >= 9
    away = seen.corrected[at] - one.sky.range - one.clock[at, :1]
    np.testing.assert_allclose(away, one.error, atol=1e-7)
    # λ times minus Doppler is the rate of range and clock, but for its noise of 5 to 10 cm/s
    rate = -0.19029367 * seen.doppler[at] - one.sky.rate - one.clock[at, 1:]
    assert 0.05 < np.nanstd(rate) < 0.1


def test_the_unit_is_of_its_grade() -> None:
    for unit, gyro, force in ((train.TACTICAL, 1e-3, 0.02), (train.INDUSTRIAL, 8e-3, 0.1)):
        one = train.ride(100.0, 3, "gaussian", unit)
        rate, push = felt(one.position, one.velocity, one.attitude, 0.01)
        off = one.log.value[:, :6] - np.concatenate([rate, push], axis=1)
        assert np.abs(off[:, :3].mean(axis=0)).max() < gyro
        assert np.abs(off[:, 3:].mean(axis=0)).max() < 3 * force
        white = np.diff(off, axis=0).std(axis=0) / np.sqrt(2)
        assert white[:3] == pytest.approx(10 * unit.gyro.noise_density, rel=0.05)
        assert white[3:] == pytest.approx(10 * unit.accelerometer.noise_density, rel=0.05)


def test_the_same_seed_is_the_same_ride_whatever_the_noise() -> None:
    heavy, plain = (train.ride(30.0, 5, noise) for noise in ("heavy", "gaussian"))
    np.testing.assert_array_equal(heavy.position, plain.position)
    np.testing.assert_array_equal(heavy.log.value[:, :6], plain.log.value[:, :6])
    assert not np.array_equal(heavy.error, plain.error)
    again = train.ride(30.0, 5, "heavy")
    np.testing.assert_array_equal(again.log.value, heavy.log.value)


def test_a_ride_needs_two_epochs() -> None:
    with pytest.raises(ValueError, match="make it longer"):
        train.ride(1.0)


def test_the_ride_begins_where_it_is_told() -> None:
    place = ecef_to_geodetic(ride(1).position[0])
    assert place == pytest.approx(BERLIN, abs=1e-9)
    assert ecef_to_enu(ride(1).position[0], *BERLIN) == pytest.approx(np.zeros(3), abs=1e-6)
