"""Experiment A4 and the four kinds of the paper: the car recipe on both real drives."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs import read
from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Log
from sensorfault.methods.catalog import recipe
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session
from sensorfault.vehicles.car import moving, roles
from sensorfault_studies.min2021 import bias_miss as study

pytestmark = pytest.mark.real

FOLDERS = tuple(study.DRIVES.values())
TRIALS = 20
METRES = 15.0


@cache
def fitted(folder: Path) -> tuple[Model, Log]:
    log = read(folder)
    cut = float(log.time[0]) + study.LEARN * log.duration_s
    return recipe("car-composite").build(log.between(end_s=cut), 0, Session()), log.between(cut)


def result(folder: Path, *faults: Fault) -> list[Event]:
    """Events between the first fault's onset and a second after its end."""
    model, rest = fitted(folder)
    found = detect(model, inject(rest, faults).log).events
    first, last = faults[0].start_s - rest.period_s, faults[0].end_s + 1.0
    return [event for event in found if first <= event.start_s <= last]


def under_way(log: Log, lasting_s: float, count: int) -> list[float]:
    """Onsets spread over the log from which the car moves for a while [s]."""
    times = moving(log, roles(log))
    starts = [t for t in times if np.sum((times >= t) & (times < t + lasting_s)) * 0.9 > 0.8 * lasting_s * rate(times)]
    starts = [t for t in starts if log.time[0] + 10 < t < log.time[-1] - lasting_s - 5]
    return [starts[i] for i in np.linspace(0, len(starts) - 1, count).astype(int)]


def rate(times: np.ndarray) -> float:
    return 1 / float(np.median(np.diff(times)))


@pytest.mark.parametrize("folder", FOLDERS)
def test_nothing_is_said_of_a_healthy_drive(folder: str, real_data: Path) -> None:
    model, rest = fitted(real_data / folder)
    events = [event for event in detect(model, rest).events if event.kind != "missing" or event.end_s is not None]
    assert events == []  # the inertial unit of drive 0708 outlives the last fix: that silence is so


@pytest.mark.parametrize("folder", FOLDERS)
def test_an_offset_of_15_m_is_found(folder: str, real_data: Path) -> None:
    _, rest = fitted(real_data / folder)
    right = []
    for seed, start in enumerate(np.linspace(rest.time[0] + 10, rest.time[-1] - 30, TRIALS)):
        whole = Fault("offset", rest.channels[rest.index("latitude")].sensor, None, float(start), 20.0, METRES)
        events = result(real_data / folder, *study._parts(whole, rest, seed))
        right.append(bool(events) and events[0].sensor == whole.sensor)
    assert np.mean(right) >= 0.95


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_silence_is_laid_to_its_sensor(folder: str, real_data: Path) -> None:
    _, rest = fitted(real_data / folder)
    for sensor in rest.sensors:
        for silence_s in (4.5 * sensor.period_s, 10.0):
            miss = Fault("missing", sensor.name, None, float(rest.time[0]) + 20.0, silence_s)
            events = result(real_data / folder, miss)
            assert ("missing", sensor.name) in {(event.kind, event.sensor) for event in events}, miss
            assert silence_s > MISSED * sensor.period_s


@pytest.mark.parametrize("folder", FOLDERS)
def test_all_four_kinds_are_found_and_named(folder: str, real_data: Path) -> None:
    _, rest = fitted(real_data / folder)
    start = under_way(rest, 6.0, 1)[0]
    receiver = rest.channels[rest.index("latitude")].sensor
    offset = Fault("offset", receiver, None, start, 5.0, METRES)
    wanted = (
        [Fault("spike", "gyro", "z", start, 0.0, 10.0, sigmas=True)],
        [Fault("frozen", "gyro", "z", start, 4.0)],
        [Fault("missing", "gyro", None, start, 4.0)],
        study._parts(offset, rest, 0),
        [replace(offset, kind="frozen", channel=name, duration_s=4.0) for name in ("latitude", "longitude")],
    )
    for faults in wanted:
        events = result(real_data / folder, *faults)
        named = [(event.sensor, event.kind) for event in events]
        assert (faults[0].sensor, faults[0].kind) in named, (faults[0], named)
