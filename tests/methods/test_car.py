"""The recipe for a whole car, on a simulated drive: all kinds of fault, and what it does without some sensors."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import recipe
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection
from sensorfault.simulation.road import drive
from sensorfault.training.session import Session

pytestmark = pytest.mark.usefixtures("hasty")
LEARN_S = 300.0
UNDER_WAY = 365.0  # from here on the car drives for a while [s]
METRE = 9.0e-6  # of latitude [deg]


@cache
def log() -> Log:
    return drive(480.0, seed=5).log


@cache
def model() -> Model:
    return recipe("car-composite").build(log().between(end_s=LEARN_S), 0, Session())


def found(*faults: Fault) -> Detection:
    return detect(model(), inject(log().between(LEARN_S), faults).log)


def test_a_healthy_drive_has_no_events() -> None:
    assert found().events == ()
    assert model().summary["cannot"] == {}
    assert all(w for c, w in zip(model().channels, model().watched, strict=True) if c.name != "altitude")


@pytest.mark.parametrize(
    "fault",
    [
        Fault("spike", "gyro", "z", 340.0, 0.0, 10.0, sigmas=True),
        Fault("spike", "accelerometer", "x", 340.0, 0.0, 10.0, sigmas=True),
        Fault("offset", "gnss", "latitude", UNDER_WAY, 20.0, 15 * METRE),
        Fault("frozen", "gyro", "y", 340.0, 4.0),
        Fault("frozen", "gnss", "latitude", UNDER_WAY, 4.0),
        Fault("missing", "gnss", None, 340.0, 4.0),
        Fault("missing", "accelerometer", None, 340.0, 4.0),
    ],
    ids=lambda fault: f"{fault.kind} {fault.where}",
)
def test_each_kind_is_found_named_and_laid_to_its_sensor(fault: Fault) -> None:
    (event,) = found(fault).events
    assert (event.sensor, event.kind, event.subject) == (fault.sensor, fault.kind, "sensor")
    assert event.start_s == pytest.approx(fault.start_s, abs=1.5)
    assert event.end_s == pytest.approx(fault.end_s, abs=3.0)


def test_without_a_receiver_the_inertial_unit_is_still_watched() -> None:
    alone = log().select([c.path for c in log().channels if c.sensor != "gnss"]).between(end_s=120.0)
    made = recipe("car-composite").build(alone, 0, Session())
    assert all(made.watched)
    assert "no position" in made.summary["cannot"]["motion-deficit"]
    assert set(made.summary["cannot"]) == {"motion-deficit", "bicycle-kalman", "side-force"}


def test_without_an_inertial_unit_the_position_is_still_watched() -> None:
    alone = log().select([c.path for c in log().channels if c.sensor == "gnss"]).between(end_s=LEARN_S)
    made = recipe("car-composite").build(alone, 0, Session())
    watched = {c.name for c, w in zip(made.channels, made.watched, strict=True) if w}
    assert {"latitude", "longitude"} <= watched
    assert "bicycle-kalman" in made.summary["cannot"]


def test_a_log_that_no_part_can_run_on() -> None:
    still = replace(log(), value=np.zeros_like(log().value)).between(end_s=60.0)
    with pytest.raises(LogError, match="moves for 0 s"):
        recipe("car-composite").build(still, 0, Session())
