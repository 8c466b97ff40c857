"""The flight that never was: its sensors agree with its motion, and the beat is where it should be."""

import numpy as np
import pytest
from scipy.signal import periodogram

from sensorfault.simulation.flapping_wing import fly
from sensorfault.simulation.road import Simulated
from sensorfault.vehicles.fixed_wing import roles


def column(result: Simulated, path: str, truth: bool = False) -> np.ndarray:
    log = result.truth if truth else result.log
    return log.value[:, log.index(path)]


@pytest.fixture(scope="module")
def flight() -> Simulated:
    return fly(120.0, seed=1)


def test_the_same_seed_is_the_same_flight(flight: Simulated) -> None:
    np.testing.assert_array_equal(fly(120.0, seed=1).log.value, flight.log.value)
    assert not np.array_equal(fly(120.0, seed=2).log.value, flight.log.value)


def test_every_role_is_there(flight: Simulated) -> None:
    found, log = roles(flight.log), flight.log
    paths = {name: log.channels[getattr(found, name)].path for name in ("height", "barometric", "vertical", "pitch")}
    assert paths == {
        "height": "gnss.altitude",
        "barometric": "barometer.altitude",
        "vertical": "gnss.down",
        "pitch": "attitude.pitch",
    }
    assert found.accelerometer is not None


def test_speeds_are_the_slopes_of_places(flight: Simulated) -> None:
    height, down = column(flight, "gnss.altitude", True), column(flight, "gnss.down", True)
    np.testing.assert_allclose(np.gradient(height, 0.02)[5:-5], -down[5:-5], atol=0.02)
    north = np.gradient(column(flight, "gnss.latitude", True), 0.02) * 6.37e6
    np.testing.assert_allclose(north[5:-5], column(flight, "gnss.north", True)[5:-5], atol=0.1)


def test_climbs_follow_throttle_and_pitch(flight: Simulated) -> None:
    climb = -column(flight, "gnss.down", True)
    for path in ("control.throttle", "attitude.pitch"):
        assert np.corrcoef(column(flight, path, True)[:-75], climb[75:])[0, 1] > 0.9


def test_turns_are_coordinated() -> None:
    still = fly(120.0, seed=4, beat_hz=0.0)
    assert np.abs(np.gradient(still.motion.heading, 0.02)).max() > 0.2
    assert np.abs(column(still, "accelerometer.y", True)).max() < 0.3
    np.testing.assert_allclose(column(still, "accelerometer.z", True).mean(), 9.9, atol=0.3)


def test_sensors_err_as_they_should(flight: Simulated) -> None:
    fresh = flight.log.fresh[:, flight.log.index("gnss.altitude")]
    assert fresh.sum() == 600
    error = (column(flight, "gnss.altitude") - column(flight, "gnss.altitude", True))[fresh]
    assert 0.5 < error.std() < 5.0
    baro = flight.log.fresh[:, flight.log.index("barometer.altitude")]
    off = (column(flight, "barometer.altitude") - column(flight, "barometer.altitude", True))[baro]
    assert np.std(np.diff(off)) == pytest.approx(0.7, abs=0.3)  # the beat
    attitude = column(flight, "attitude.pitch") - column(flight, "attitude.pitch", True)
    assert np.rad2deg(attitude.std()) < 1.5


@pytest.mark.parametrize("path", ["accelerometer.z", "accelerometer.x", "gyro.y"])
def test_the_beat_and_its_overtone_are_heard(flight: Simulated, path: str) -> None:
    f, power = periodogram(column(flight, path), 50.0)

    def near(hz: float) -> float:
        return float(power[np.abs(f - hz) < 0.1 * hz].sum())

    assert near(6.0) > 10 * near(9.0)
    assert near(12.0) > 3 * near(9.0)


def test_fixed_wings_do_not_beat() -> None:
    still, beating = fly(60.0, seed=3, beat_hz=0.0), fly(60.0, seed=3)
    for path in ("accelerometer.z", "barometer.altitude"):
        rough = [np.std(np.diff(column(one, path)[one.log.fresh[:, one.log.index(path)]])) for one in (still, beating)]
        assert rough[1] > 2 * rough[0]
    np.testing.assert_array_equal(still.motion.position, beating.motion.position)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"duration_s": 0.0}, "fewer than two samples"),
        ({"gnss_hz": 0.0}, "gnss_hz is 0"),
        ({"barometer_hz": 99.0}, "barometer_hz is 99"),
        ({"beat_hz": 30.0}, "beat_hz is 30"),
    ],
)
def test_no_such_flight(wrong: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        fly(**wrong)
