"""The whole aircraft on a simulated flight: each fault at the right door, and none where nobody can know."""

from functools import cache

import numpy as np
import pytest

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection
from sensorfault.simulation.flapping_wing import fly
from sensorfault.training.session import SILENT

pytestmark = pytest.mark.usefixtures("hasty")

FITTED_S, ONSET_S = 420.0, 520.0
RECEIVER = tuple(f"gnss.{name}" for name in ("latitude", "longitude", "altitude", "north", "east", "down"))


@cache
def flight() -> Log:
    log = fly(700.0, seed=1, beat_hz=0.0, imu_hz=10.0, gnss_hz=5.0, barometer_hz=5.0).log
    return log.select([*(f"gyro.{axis}" for axis in "xyz"), *RECEIVER, "barometer.altitude", "attitude.pitch"])


@cache
def fitted() -> Model:
    return METHODS["drone-composite"].build(flight().between(end_s=FITTED_S), 0, SILENT)


def result(*faults: Fault) -> Detection:
    return detect(fitted(), inject(flight().between(FITTED_S), list(faults)).log)


def accused(*faults: Fault) -> set[str | None]:
    return {event.sensor for event in result(*faults).events}


def test_what_it_is_made_of() -> None:
    assert fitted().summary["parts"] == ["relative-conditioning", "height-agreement", "motion-deficit"]
    assert list(fitted().summary["cannot"]) == ["velocity against the inertial unit"]
    watched = [channel.path for channel, mine in zip(fitted().channels, fitted().watched, strict=True) if mine]
    assert {"gyro.x", "gnss.altitude", "gnss.latitude", "barometer.altitude", "attitude.pitch"} <= set(watched)


def test_a_healthy_flight_raises_nothing() -> None:
    assert not result().events


def test_a_fault_of_each_sensor_is_laid_on_it() -> None:
    faults = (
        Fault("drift", "gnss", "altitude", ONSET_S, 60.0, 1 / 3),
        Fault("offset", "gnss", "altitude", ONSET_S, 20.0, 15.0),
        Fault("offset", "gnss", "latitude", ONSET_S, 20.0, 40 / 111e3),
        Fault("frozen", "gyro", None, ONSET_S, 10.0),
        Fault("frozen", "attitude", None, ONSET_S, 10.0),
        Fault("missing", "barometer", None, ONSET_S, 10.0),
    )
    for fault in faults:
        assert {fault.sensor} <= accused(fault) <= {fault.sensor, None}, fault


def test_a_barometer_against_a_receiver_is_unknown_which() -> None:
    """Its own vertical speed is the receiver's: it may be wrong together with its height."""
    assert accused(Fault("drift", "barometer", "altitude", ONSET_S, 60.0, 0.5)) == {None}


def test_a_receiver_that_leads_height_and_climb_astray_is_not_laid_on_the_barometer() -> None:
    both = Fault("drift", "gnss", "altitude", ONSET_S, 60.0, 0.5), Fault("offset", "gnss", "down", ONSET_S, 60.0, -0.5)
    detection = result(*both)
    during = [event for event in detection.events if event.start_s < ONSET_S + 60.0]
    assert during
    assert "barometer" not in {event.sensor for event in detection.events}


def test_height_is_rebuilt_from_the_barometer() -> None:
    log, detection = flight().between(FITTED_S), result(Fault("drift", "gnss", "altitude", ONSET_S, 60.0, 0.5))
    c = log.index("gnss.altitude")
    rows = (log.time > ONSET_S + 40.0) & (log.time < ONSET_S + 60.0) & log.fresh[:, c]
    assert np.abs(detection.repaired[rows, c] - log.value[rows, c]).max() < 8.0  # 20 to 30 without
