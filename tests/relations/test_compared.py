"""The default method names what lies, and nobody on healthy drives, however the inertial unit is mounted."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from relations import drives
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.relations.axes import ROTATIONS
from sensorfault.runtime.compared import Comparison, compare, comparison_of
from sensorfault.runtime.result import Detection


@cache
def copter() -> Log:
    return drives.copter()


@cache
def fitted_copter() -> Comparison:
    return comparison_of(drives.copter(seed=1), drives.copter(seed=2))


@cache
def fitted_car() -> Comparison:
    return comparison_of(drives.car(seed=1), drives.car(seed=2))


def named(found: Detection) -> set[str | None]:
    return {event.sensor for event in found.events}


COPTER_FAULTS = {
    "the receiver's height drifts": ("gnss.altitude", lambda t, x: x + 1.0 * (t - 100), "gnss"),
    "its position jumps": ("gnss.latitude", lambda t, x: x + 15.0 / drives.EARTH_M, "gnss"),
    "the barometer is off": ("barometer.altitude", lambda t, x: x + 12.0, "barometer"),
    "the barometer drifts": ("barometer.altitude", lambda t, x: x + 0.8 * (t - 100), "barometer"),
}


@pytest.mark.parametrize("what", COPTER_FAULTS)
def test_a_lie_in_flight_is_named(what: str) -> None:
    path, how, sensor = COPTER_FAULTS[what]
    log = drives.changed(copter(), path, 100.0, 150.0, how)
    found = compare(log, fitted_copter())
    assert named(found) == {sensor}
    first = found.events[0]
    assert 100.0 <= first.start_s < 115.0
    assert first.found_by is not None
    rows = (log.time > first.start_s + 1) & (log.time < 149)
    assert (found.sensor[rows, [s.name for s in log.sensors].index(sensor)] == FAULT).mean() > 0.5
    assert np.isnan(found.repaired[rows][:, log.index(path)]).mean() > 0.5


CAR_FAULTS = {
    "wheels slip": ("wheels.speed", lambda t, x: 1.3 * x, {"wheels"}),
    "the yaw gyro is off": ("gyro.z", lambda t, x: x + 0.1, {"gyro"}),
    "the steering is off": ("steering.angle", lambda t, x: x + 0.5, {"steering"}),
    "the position glitches": ("gnss.longitude", lambda t, x: x + 40 / drives.EARTH_M, {"gnss"}),
}


@pytest.mark.parametrize("what", CAR_FAULTS)
def test_a_lie_on_the_road_is_named(what: str) -> None:
    path, how, sensors = CAR_FAULTS[what]
    found = compare(drives.changed(drives.car(seed=3), path, 150.0, 200.0, how), fitted_car())
    assert named(found) == sensors
    assert 150.0 <= found.events[0].start_s < 165.0


@pytest.mark.parametrize("seed", [5, 6, 7])
def test_healthy_drives_are_silent(seed: int) -> None:
    for found in (
        compare(drives.copter(seed=seed), fitted_copter()),
        compare(drives.car(seed=seed), fitted_car()),
        compare(drives.copter(seed=seed)),
        compare(drives.car(seed=seed)),
    ):
        assert found.events == (), found.events
        assert (found.sample != FAULT).all()
        assert (found.sample == OK).mean() > 0.9


@pytest.mark.parametrize("gravity", [1.0, -1.0])
@pytest.mark.parametrize("turn", ROTATIONS[::5], ids=str)
def test_the_mounting_does_not_matter(turn: np.ndarray, gravity: float) -> None:
    """A law: verdicts are the same for every mounting of the inertial unit, and for both signs of gravity."""
    path, how, _ = COPTER_FAULTS["the barometer is off"]
    bad = drives.changed(copter(), path, 100.0, 150.0, how)
    plain, turned = compare(bad), compare(drives.mounted(bad, turn, gravity))
    assert named(turned) == named(plain)
    np.testing.assert_array_equal(turned.sensor, plain.sensor)
    assert named(compare(drives.mounted(copter(), turn, gravity))) == set()


ASKEW = [Rotation.random(random_state=seed).as_matrix() for seed in range(3)]


@pytest.mark.parametrize("gravity", [1.0, -1.0])
@pytest.mark.parametrize("turn", ASKEW, ids=str)
@pytest.mark.parametrize("vehicle", ["copter", "car"])
def test_a_unit_may_be_mounted_askew(vehicle: str, turn: np.ndarray, gravity: float) -> None:
    log, faults = (copter(), COPTER_FAULTS) if vehicle == "copter" else (drives.car(seed=3), CAR_FAULTS)
    path, how, sensors = faults["the barometer is off" if vehicle == "copter" else "wheels slip"]
    bad = drives.mounted(drives.changed(log, path, 150.0, 200.0, how), turn, gravity)
    found = compare(bad, comparison_of(*[drives.mounted(one, turn, gravity) for one in healthy(vehicle)]))
    assert named(found) == ({sensors} if isinstance(sensors, str) else sensors)
    assert named(compare(drives.mounted(log, turn, gravity))) == set()


def healthy(vehicle: str) -> list[Log]:
    made = drives.copter if vehicle == "copter" else drives.car
    return [made(seed=1), made(seed=2)]


def test_a_silent_receiver_is_missing_and_nobody_else() -> None:
    found = compare(drives.changed(copter(), "gnss.latitude", 100.0, 130.0, lambda t, x: np.nan * x))
    log = copter()
    value = log.value.copy()
    rows = (log.time >= 100) & (log.time < 130)
    value[np.ix_(rows, list(log.of("gnss")))] = np.nan
    silent = Log(log.time, value, log.fresh & np.isfinite(value), log.channels, log.sensors)
    found = compare(silent)
    assert [(event.sensor, event.kind) for event in found.events] == [("gnss", "missing")]
    assert found.events[0].start_s == pytest.approx(100.0, abs=0.5)


def test_a_frozen_sensor_is_frozen() -> None:
    found = compare(drives.changed(copter(), "barometer.altitude", 100.0, 140.0, lambda t, x: 0 * t + 30.123))
    assert [(event.sensor, event.kind) for event in found.events] == [("barometer", "frozen")]


def test_one_sample_of_the_barometer() -> None:
    found = compare(drives.changed(copter(), "barometer.altitude", 100.0, 100.02, lambda t, x: x + 900.0))
    assert [(event.sensor, event.kind) for event in found.events] == [("barometer", "spike")]


def test_a_pause_of_the_recorder_is_nobodys_fault() -> None:
    log = copter()
    kept = (log.time < 90) | (log.time > 130)
    found = compare(Log(log.time[kept], log.value[kept], log.fresh[kept], log.channels, log.sensors))
    assert found.events == ()


def test_two_witnesses_can_say_that_something_is_wrong_but_not_which() -> None:
    log = copter().select([c.path for c in copter().channels if c.path in ("barometer.altitude", "gnss.altitude")])
    found = compare(drives.changed(log, "barometer.altitude", 100.0, 150.0, lambda t, x: x + 25.0))
    (event,) = found.events
    assert event.sensor is None
    assert set(event.candidates) == {"barometer", "gnss"}


def test_what_nothing_contradicts_is_unknown_not_ok() -> None:
    log = copter().select([c.path for c in copter().channels if c.sensor in ("gyro", "accelerometer")])
    found = compare(log)
    assert found.coverage is not None
    assert not found.coverage.compared
    assert set(found.coverage.not_compared) == {"gyro", "accelerometer"}
    assert (found.sensor == UNKNOWN).all()


def test_a_log_too_short_to_judge_is_refused() -> None:
    with pytest.raises(LogError, match=r"none of its sensors can be checked .*too short"):
        compare(copter().between(end_s=3.0))


def test_what_is_said_and_samples_of_a_second_unit_are_no_witnesses() -> None:
    log = copter()
    said = (
        *(Channel(axis, "gyro2", "rad/s") for axis in "xyz"),
        Channel("fix_type", "gnss", watch=False, kind="quality"),
        Channel("latitude", "filter", "rad", watch=False, kind="context"),
        Channel("longitude", "filter", "rad", watch=False, kind="context"),
        *(Channel(axis, "magnetometer2_uncalibrated", "T") for axis in "xyz"),
    )
    value = np.full((len(log), len(said)), np.nan)
    value[::25] = 3 + np.random.default_rng(4).normal(size=value[::25].shape)
    more = (Sensor("gyro2", 0.5), Sensor("filter", 0.5), Sensor("magnetometer2_uncalibrated", 0.5))
    wide = replace(
        log,
        value=np.concatenate([log.value, value], axis=1),
        fresh=np.concatenate([log.fresh, np.isfinite(value)], axis=1),
        channels=(*log.channels, *said),
        sensors=(*log.sensors, *more),
    )
    found, before = compare(wide, fitted_copter()), compare(log, fitted_copter())
    assert found.events == before.events == ()
    assert found.coverage is not None
    assert before.coverage is not None
    assert found.coverage.compared == before.coverage.compared
    assert set(found.coverage.not_compared) - set(before.coverage.not_compared) == {
        "gyro2",
        "magnetometer2_uncalibrated",
    }
    assert not found.watched[[c.path for c in wide.channels].index("gnss.fix_type")]


def test_a_receiver_that_has_not_begun_is_unknown_not_frozen() -> None:
    early = drives.car(seed=3)
    for path in ("gnss.latitude", "gnss.longitude", "gnss.speed", "gnss.course"):
        early = drives.changed(early, path, 0.0, 60.0, lambda t, x: np.full_like(x, x[np.isfinite(x)][0]))
    found = compare(early, fitted_car())
    assert named(found) == set()
    late = drives.changed(drives.car(seed=3), "gnss.latitude", 100.0, 160.0, lambda t, x: np.full_like(x, x[0]))
    assert named(compare(late, fitted_car())) == {"gnss"}


def test_an_acceleration_without_gravity_is_no_accelerometer() -> None:
    log = copter()
    value = log.value.copy()
    columns = list(log.of("accelerometer"))
    value[:, columns] -= np.median(value[:, columns], axis=0)
    found = compare(Log(log.time, value, log.fresh, log.channels, log.sensors))
    assert named(found) == set()
    assert found.coverage is not None
    assert "accelerometer" in found.coverage.not_compared
    value[:, columns] = 0.0
    assert "accelerometer" in named(compare(Log(log.time, value, log.fresh, log.channels, log.sensors)))
