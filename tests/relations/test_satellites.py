"""Raw satellites become a receiver, and each of them is held against all others."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from relations.drives import changed
from sensorfault.core.verdicts import FAULT, OK
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.relations.constellation import solved
from sensorfault.relations.signals import signals_of
from sensorfault.runtime.compared import compare, comparison_of
from sensorfault.simulation.train import Ride, ride

SECONDS = 240.0


@cache
def ridden(seed: int = 0) -> Ride:
    return ride(SECONDS, seed, imu_hz=10)


def with_wheels(made: Ride) -> Log:
    """The ride with its true speed, a little noisy, as its wheels would have it."""
    log = made.log
    speed = np.linalg.norm(made.velocity, axis=1)
    speed = np.maximum(speed + np.random.default_rng(0).normal(0, 0.03, len(log)), 0.0)
    return replace(
        log,
        value=np.column_stack([log.value, speed]),
        fresh=np.column_stack([log.fresh, np.ones(len(log), bool)]),
        channels=(*log.channels, Channel("speed", "wheel", "m/s")),
        sensors=(*log.sensors, Sensor("wheel", 10.0)),
    )


def named(log: Log) -> set[str | None]:
    return {event.sensor for event in compare(log).events}


def test_the_place_and_the_speed_are_the_true_ones() -> None:
    made = ridden()
    sky = solved(made.log)
    assert sky is not None
    rows = np.searchsorted(made.log.time, sky.time)
    speed = np.linalg.norm(made.velocity[rows], axis=1)
    assert np.median(np.abs(np.linalg.norm(sky.velocity[:, :2], axis=1) - speed)) < 0.2
    way = 6_371_000.0 * np.hypot(np.diff(sky.degrees[:, 0]), np.diff(sky.degrees[:, 1]) * np.cos(sky.degrees[0, 0]))
    assert way.sum() == pytest.approx(np.trapezoid(np.linalg.norm(made.velocity, axis=1), made.log.time), rel=0.3)
    assert np.ptp(sky.height) < 100


def test_one_satellite_that_lies_is_named() -> None:
    made = ridden()
    sky = solved(made.log)
    assert sky is not None
    liar = sky.names[int(np.argmax(np.isfinite(sky.off).sum(axis=0)))]
    lie = changed(made.log, f"{liar}.corrected_m", 120.0, 160.0, lambda t, x: x + 60.0)
    found = compare(lie)
    assert [event.sensor for event in found.events] == [liar]
    assert 119.0 <= found.events[0].start_s <= 123.0
    assert found.events[0].end_s is not None
    assert 157.0 <= found.events[0].end_s <= 161.0
    rows = (lie.time > 125) & (lie.time < 155)
    names = [sensor.name for sensor in lie.sensors]
    assert (found.sensor[rows, names.index(liar)] == FAULT).all()
    seen = [
        i for i, name in enumerate(names) if f"{name}.corrected_m" in {c.path for c in lie.channels} and name != liar
    ]
    assert (found.sensor[rows][:, seen] == OK).mean() > 0.5
    assert found.coverage is not None
    assert found.coverage.compared[liar] == ("satellites",)


def test_slipping_wheels_are_named_and_no_satellite() -> None:
    log = changed(with_wheels(ridden()), "wheel.speed", 150.0, 170.0, lambda t, x: 1.3 * x)
    assert named(log) == {"wheel"}


@pytest.mark.parametrize("seed", [1, 2])
def test_healthy_rides_are_silent(seed: int) -> None:
    assert named(with_wheels(ridden(seed))) == set()


def test_ranges_may_err_as_much_as_they_did_in_healthy_rides() -> None:
    made = ridden()
    sky = solved(made.log)
    assert sky is not None
    liar = sky.names[int(np.argmax(np.isfinite(sky.off).sum(axis=0)))]
    far = changed(with_wheels(made), f"{liar}.corrected_m", 120.0, 160.0, lambda t, x: x + 60.0)
    known = comparison_of(far)
    assert compare(far, known).events == ()
    further = changed(with_wheels(made), f"{liar}.corrected_m", 120.0, 160.0, lambda t, x: x + 150.0)
    assert {event.sensor for event in compare(further, known).events} == {liar}


def test_an_odometry_of_speeds_is_of_the_wheels() -> None:
    log = with_wheels(ridden())
    named = replace(log, sensors=(*log.sensors[:-1], replace(log.sensors[-1], name="odometry")))
    named = replace(named, channels=(*log.channels[:-1], replace(log.channels[-1], sensor="odometry", name="x")))
    assert signals_of(named)["wheel"].sensor == "odometry"


def test_too_few_satellites_are_no_receiver() -> None:
    log = ridden().log
    few = {s.name for s in log.sensors if any(log.channels[i].name == "corrected_m" for i in log.of(s.name))}
    kept = set(sorted(few)[:3])
    column = np.array([c.sensor in few - kept for c in log.channels])
    assert solved(replace(log, fresh=log.fresh & ~column, value=np.where(column, np.nan, log.value))) is None
