"""The laws of the default method, over a car, a copter, a wing, a train, an underwater vehicle and an arm.

Those of the other methods stand in tests/laws: they speak of a monitor's state, which the default has not.
"""

import pickle
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import sensorfault as sf
from relations.vehicles import CAR, COPTER, VEHICLES, Vehicle, joints
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.logs.table import Log, LogError
from sensorfault.runtime.compared import ComparingDetector, Comparison
from sensorfault.runtime.result import Detection

every_vehicle = pytest.mark.parametrize("vehicle", VEHICLES, ids=str)
LONGEST_S = 60.0  # window of a comparison
SETTLES_S = 10.0  # a verdict stands so long after the last alarm, or until the next measurement


@cache
def healthy(vehicle: Vehicle) -> Detection:
    return sf.detect(vehicle.model, vehicle.log)


@cache
def lying(vehicle: Vehicle, path: str) -> Detection:
    return sf.detect(vehicle.model, vehicle.lied(path, vehicle.lies[path]))


def first_lie(vehicle: Vehicle) -> str:
    return next(iter(vehicle.lies))


def troubled(vehicle: Vehicle) -> Detection:
    return lying(vehicle, first_lie(vehicle))


def assert_same(one: Detection, other: Detection) -> None:
    """The same verdicts and the same events."""
    np.testing.assert_array_equal(one.sensor, other.sensor)
    np.testing.assert_array_equal(one.sample, other.sample)
    assert one.events == other.events


def accuses_only(found: Detection, liar: str, vehicle: Vehicle) -> bool:
    """Each event names the liar, or where partners cannot tell, has it among those of whom one lies."""
    mine = {liar, vehicle.alike}
    return all({event.sensor, *event.candidates} & mine for event in found.events)


def named(found: Detection) -> set[tuple[str | None, tuple[str, ...]]]:
    return {(event.sensor, event.candidates) for event in found.events}


def log_with(log: Log, value: np.ndarray) -> Log:
    return replace(log, value=value, fresh=log.fresh & np.isfinite(value))


def parted(log: Log, rows: np.ndarray) -> Log:
    return replace(log, time=log.time[rows], value=log.value[rows], fresh=log.fresh[rows])


def silent(vehicle: Vehicle, sensor: str) -> Log:
    value = vehicle.log.value.copy()
    value[np.ix_(vehicle.rows, list(vehicle.log.of(sensor)))] = np.nan
    return log_with(vehicle.log, value)


# 0. What the others rest on: the healthy log is healthy, and a lie is named.


@every_vehicle
def test_healthy_is_ok(vehicle: Vehicle) -> None:
    found = healthy(vehicle)
    assert found.events == ()
    assert found.coverage is not None
    compared = [
        [sensor.name for sensor in vehicle.log.sensors].index(s) for s in found.coverage.compared if s in names(vehicle)
    ]
    assert compared
    assert (found.sensor[:, compared] == OK).mean() > 0.9
    rest = [i for i in range(len(vehicle.log.sensors)) if i not in compared]
    assert (found.sensor[:, rest] == UNKNOWN).all()


def names(vehicle: Vehicle) -> list[str]:
    return [sensor.name for sensor in vehicle.log.sensors]


LIES = [(vehicle, path) for vehicle in VEHICLES for path in vehicle.lies]


@pytest.mark.parametrize(("vehicle", "path"), LIES, ids=str)
def test_a_lie_is_found_and_accuses_nobody_else(vehicle: Vehicle, path: str) -> None:
    found = lying(vehicle, path)
    assert found.events
    assert accuses_only(found, path.partition(".")[0], vehicle)
    assert vehicle.lie_s[0] - 2 < found.events[0].start_s < vehicle.lie_s[1]


@every_vehicle
def test_a_lie_that_nobody_else_sees_accuses_nobody_else(vehicle: Vehicle) -> None:
    for path, size in vehicle.alone.items():
        assert accuses_only(sf.detect(vehicle.model, vehicle.lied(path, size)), path.partition(".")[0], vehicle), path


@every_vehicle
def test_before_a_lie_all_is_as_without_it(vehicle: Vehicle) -> None:
    before = vehicle.log.time < vehicle.lie_s[0] - 2
    for path in vehicle.lies:
        np.testing.assert_array_equal(lying(vehicle, path).sensor[before], healthy(vehicle).sensor[before])


# 1. However the log is cut, clocked, ordered or written.


@every_vehicle
def test_stream_equals_replay(vehicle: Vehicle) -> None:
    """At every comparison the verdicts are those of the log so far."""
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    log = log.between(vehicle.lie_s[0] - 30.0, vehicle.lie_s[0] + 75.0)
    live = sf.Live(vehicle.model)
    compared_s, seconds = -np.inf, 0
    for time, value, fresh in zip(log.time, log.value, log.fresh, strict=True):
        now = live.push(time, value, fresh)
        if time - compared_s < 1.0:
            continue
        compared_s, seconds = time, seconds + 1
        if seconds % 24 == 20:  # sooner there is nothing to compare
            so_far = sf.detect(vehicle.model, parted(log, log.time <= time))
            np.testing.assert_array_equal(now.sensor, so_far.sensor[-1], f"at {time} s")
            assert now.sample == so_far.sample[-1]
            assert {e.sensor for e in live.open()} == {e.sensor for e in so_far.events if e.end_s is None}


@every_vehicle
def test_parts_one_after_the_other_name_the_same(vehicle: Vehicle) -> None:
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    parts = ComparingDetector(vehicle.model)
    middle = sum(vehicle.lie_s) / 2
    for rows in (log.time < middle, log.time >= middle):
        parts.take(parted(log, rows))
    found = parts.found()
    assert named(found) == named(troubled(vehicle))
    for one, other in zip(found.events, troubled(vehicle).events, strict=True):
        assert one.start_s == pytest.approx(other.start_s, abs=3.0)
        assert one.end_s == other.end_s or one.end_s == pytest.approx(other.end_s, abs=3.0)


@every_vehicle
def test_when_the_clock_begins_does_not_matter(vehicle: Vehicle) -> None:
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    later = sf.detect(vehicle.model, replace(log, time=log.time + 4096.0))
    np.testing.assert_array_equal(later.sensor, troubled(vehicle).sensor)
    for one, other in zip(later.events, troubled(vehicle).events, strict=True):
        assert (one.sensor, one.kind, one.candidates) == (other.sensor, other.kind, other.candidates)
        assert one.start_s - 4096.0 == pytest.approx(other.start_s, abs=1e-6)


@every_vehicle
def test_the_order_of_channels_and_sensors_does_not_matter(vehicle: Vehicle) -> None:
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    order = np.random.default_rng(5).permutation(len(log.channels))
    turned = [int(i) for i in np.random.default_rng(6).permutation(len(log.sensors))]
    other = replace(
        log,
        value=log.value[:, order],
        fresh=log.fresh[:, order],
        channels=tuple(log.channels[i] for i in order),
        sensors=tuple(log.sensors[i] for i in turned),
    )
    found = sf.detect(vehicle.model, other)
    np.testing.assert_array_equal(found.sensor, troubled(vehicle).sensor[:, turned])
    np.testing.assert_array_equal(found.sample, troubled(vehicle).sample)
    key = lambda event: (event.start_s, event.sensor or "", sorted(event.candidates))  # noqa: E731
    assert sorted(map(key, found.events)) == sorted(map(key, troubled(vehicle).events))


SHOWN_AS = {"rad/s": "deg/s", "deg/s": "mrad/s", "m/s": "km/h", "deg": "rad", "rad": "deg", "gauss": "uT"}


@every_vehicle
def test_the_units_in_which_a_log_is_shown_do_not_matter(vehicle: Vehicle) -> None:
    """Inside, all is SI."""
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    channels = tuple(replace(c, unit=SHOWN_AS.get(c.unit, c.unit)) for c in log.channels)
    assert_same(sf.detect(vehicle.model, replace(log, channels=channels)), troubled(vehicle))


@every_vehicle
def test_rows_without_a_measurement_change_nothing(vehicle: Vehicle) -> None:
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    between = (log.time[:-1] + log.time[1:]) / 2
    time = np.concatenate([log.time, between])
    order = np.argsort(time, kind="stable")
    nothing = log.value[:-1] + 1.0  # whatever stands there: it is not new
    more = replace(
        log,
        time=time[order],
        value=np.concatenate([log.value, nothing])[order],
        fresh=np.concatenate([log.fresh, np.zeros_like(nothing, bool)])[order],
    )
    found = sf.detect(vehicle.model, more)
    assert found.events == troubled(vehicle).events
    np.testing.assert_array_equal(found.sensor[np.argsort(order)[: len(log)]], troubled(vehicle).sensor)


@every_vehicle
def test_wherever_a_log_ends_the_last_verdict_stands(vehicle: Vehicle) -> None:
    """The next measurement of a slow sensor may not be there yet."""
    log = parted(vehicle.log, vehicle.log.time > 0.0)  # it begins between two measurements of slow sensors
    whole = sf.detect(vehicle.model, log)
    for end in range(len(log) * 3 // 4, len(log), len(log) // 23):
        found = sf.detect(vehicle.model, parted(log, np.arange(len(log)) <= end))
        np.testing.assert_array_equal(found.sensor[-1], whole.sensor[end])


# 2. What is not there is unknown, and nobody else's fault.


SILENCES = list(dict.fromkeys((vehicle, path.partition(".")[0]) for vehicle, path in LIES))


@pytest.mark.parametrize(("vehicle", "sensor"), SILENCES, ids=str)
def test_a_silent_sensor_is_not_ok_and_accuses_nobody_else(vehicle: Vehicle, sensor: str) -> None:
    found = sf.detect(vehicle.model, silent(vehicle, sensor))
    assert accuses_only(found, sensor, vehicle)
    gone = vehicle.rows & (vehicle.log.time > vehicle.lie_s[0] + 2.0) & (vehicle.log.time < vehicle.lie_s[1] - 1.0)
    assert (found.sensor[gone, names(vehicle).index(sensor)] != OK).all()


@every_vehicle
def test_a_pause_of_all_is_unknown_and_nobodys_fault(vehicle: Vehicle) -> None:
    value = vehicle.log.value.copy()
    value[vehicle.rows] = np.nan
    found = sf.detect(vehicle.model, log_with(vehicle.log, value))
    assert found.events == ()
    late = vehicle.rows & (vehicle.log.time > vehicle.lie_s[0] + 1.0) & (vehicle.log.time < vehicle.lie_s[1] - 1.0)
    assert (found.sensor[late] == UNKNOWN).all()
    assert (found.sample[late] == UNKNOWN).all()


@every_vehicle
def test_what_is_no_number_is_not_there(vehicle: Vehicle) -> None:
    """... whether or not the log says that it is new."""
    sensor = first_lie(vehicle).partition(".")[0]
    said = silent(vehicle, sensor)
    assert_same(sf.detect(vehicle.model, replace(said, fresh=vehicle.log.fresh)), sf.detect(vehicle.model, said))


@pytest.mark.parametrize("number", [1e4, 1e7, 1e9, -1e30, 1e300, np.inf], ids=str)
@every_vehicle
def test_absurd_numbers_accuse_nobody_else(vehicle: Vehicle, number: float) -> None:
    """... nor is anything divided by nothing or too large to be squared: a warning is an error here."""
    for path in vehicle.lies:
        value = vehicle.log.value.copy()
        column = vehicle.log.index(path)
        value[vehicle.rows, column] = np.where(np.isfinite(value[vehicle.rows, column]), number, np.nan)
        found = sf.detect(vehicle.model, replace(vehicle.log, value=value))
        assert accuses_only(found, path.partition(".")[0], vehicle), path


@every_vehicle
def test_it_comes_back(vehicle: Vehicle) -> None:
    """After a lie, a silence and a pause, once the longest window has left them behind."""
    back = vehicle.log.time > vehicle.lie_s[1] + LONGEST_S + SETTLES_S
    assert (vehicle.log.time[back][-1] - vehicle.log.time[back][0]) > 10
    nothing = vehicle.log.value.copy()
    nothing[vehicle.rows] = np.nan
    sensor = first_lie(vehicle).partition(".")[0]
    for found in (
        troubled(vehicle),
        sf.detect(vehicle.model, silent(vehicle, sensor)),
        sf.detect(vehicle.model, log_with(vehicle.log, nothing)),
    ):
        np.testing.assert_array_equal(found.sensor[back], healthy(vehicle).sensor[back])


# 3. What is known of a vehicle: limits, and a file.


@every_vehicle
def test_infinite_limits_are_silent_and_none_alarms_wherever_there_is_a_test(vehicle: Vehicle) -> None:
    def with_limit(limit: float) -> Comparison:
        assert vehicle.model.learned is not None
        return replace(
            vehicle.model,
            learned=replace(vehicle.model.learned, limit=dict.fromkeys(vehicle.model.learned.limit, limit)),
        )

    assert sf.detect(with_limit(np.inf), vehicle.log).events == ()
    loud = sf.detect(with_limit(1e-12), vehicle.log)
    assert (loud.sample == FAULT)[(healthy(vehicle).sensor == OK).any(axis=1)].mean() > 0.9


@every_vehicle
def test_saved_and_loaded_it_says_the_same(vehicle: Vehicle, tmp_path: Path) -> None:
    before = repr(vehicle.model.learned)
    file = tmp_path / "model.sensorfault"
    sf.save(vehicle.model, file)
    back = sf.load(file)
    log = vehicle.lied(first_lie(vehicle), vehicle.lies[first_lie(vehicle)])
    assert_same(sf.detect(back, log), troubled(vehicle))
    assert repr(vehicle.model.learned) == before, "judging a log changes what was learned"


def test_vehicles_have_no_neighbours() -> None:
    """Two with one model, pushed in turns."""
    logs = [COPTER.log.between(end_s=30.0), COPTER.lied("barometer.altitude", 15.0).between(20.0, 50.0)]
    alone = [pushed(sf.Live(COPTER.model), log) for log in logs]
    lives = [sf.Live(COPTER.model) for _ in logs]
    for k in range(len(logs[0])):
        for log, live, expected in zip(logs, lives, alone, strict=True):
            np.testing.assert_array_equal(live.push(log.time[k], log.value[k], log.fresh[k]).sensor, expected[k])


def pushed(live: sf.Live, log: Log) -> np.ndarray:
    return np.array([live.push(*row).sensor for row in zip(log.time, log.value, log.fresh, strict=True)])


def test_what_stays_silent_stays_missing() -> None:
    """... also when the last measurement lies further back than what is kept."""
    log = CAR.make(150.0, 3)
    value = log.value.copy()
    value[np.ix_(log.time > 30.0, list(log.of("wheels")))] = np.nan
    live = sf.Live(CAR.model)
    for row in zip(log.time, value, log.fresh & np.isfinite(value), strict=True):
        now = live.push(*row)
        if row[0] > 45.0:
            assert [(event.sensor, event.kind) for event in live.open()] == [("wheels", "missing")], row[0]
            assert now.sensor[names(CAR).index("wheels")] == FAULT
    assert live.events == []
    assert live.open()[0].start_s == pytest.approx(30.0, abs=0.5)


def test_it_can_be_pickled_and_goes_on() -> None:
    log = CAR.lied("wheels.speed", 6.0).between(end_s=90.0)
    live = sf.Live(CAR.model)
    for k in range(len(log)):
        if k == len(log) * 9 // 10:
            copy = pickle.loads(pickle.dumps(live))
        row = log.time[k], log.value[k], log.fresh[k]
        now = live.push(*row)
        if k >= len(log) * 9 // 10:
            np.testing.assert_array_equal(copy.push(*row).sensor, now.sensor)


# 4. An arm has nothing that the default compares.


def test_of_an_arm_it_says_that_nothing_can_be_compared() -> None:
    with pytest.raises(
        LogError, match=r"none of its sensors can be checked .*tachometer1: no relation to other .*--method"
    ):
        sf.detect(joints())
    assert not isinstance(sf.fit(joints(2000)), Comparison)
