"""What the methods make of a follower and its leaders."""

from functools import cache

import numpy as np
import pytest

import missions
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.ranging.range_filter import Filter, cubature, fitted, followed
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.simulation.underwater import sail
from sensorfault.training.ranges import Lesson, spoiled, submerged, surfaced
from sensorfault.training.session import SILENT

LEARNED_S = 450.0


@cache
def built(name: str) -> Model:
    return METHODS[name].build(missions.healthy().log.between(end_s=LEARNED_S), 0, SILENT)


def test_noise_is_found() -> None:
    log = missions.healthy().log
    own = fitted(log, followed("test", log), Filter())
    assert 0.01 < own.q < 0.6
    assert own.sigma_m == pytest.approx(3.0, rel=0.2)


@pytest.mark.parametrize("name", ["cooperative", "chi-square-ackf-01", "anfis-cubature-9m", "logistic-cubature"])
def test_a_drift_and_a_jam_are_laid_on_their_leaders(name) -> None:
    faults = [
        Fault("drift", "leader1", "range", 550.0, 70.0, 0.6),
        Fault("offset", "leader2", "range", 700.0, 60.0, 40.0),
    ]
    log = submerged(inject(missions.healthy().log, faults).log.between(LEARNED_S), (0, 1))
    events = detect(built(name), log).events
    for fault in faults:
        mine = [e for e in events if e.sensor == fault.sensor and fault.start_s < e.start_s < fault.end_s]
        assert mine
        assert mine[0].start_s < fault.start_s + 45
    other = [e for e in events if e.sensor == "leader2" and 550 < e.start_s < 620]
    assert len(other) <= 1


def test_a_frozen_range_is_named_though_it_is_near() -> None:
    """Where a leader keeps its distance a repeated range is right, and still no measurement."""
    log = missions.healthy().log
    jam = Fault("frozen", "leader2", "range", 600.0, 200.0)
    result = detect(built("cooperative"), submerged(inject(log, [jam]).log.between(LEARNED_S), (0, 1)))
    mine = [e for e in result.events if e.sensor == "leader2" and e.start_s > 600]
    assert mine
    assert "frozen" in {e.kind for e in mine}


def test_fixes_tell_the_errors_of_ranges() -> None:
    mission = missions.healthy()
    bias = Fault("offset", "leader1", "range", 300.0, 100.0, 25.0)
    log = inject(mission.log, [bias]).log
    vehicle = cubature(log, followed("test", log), Filter()).vehicle
    error = surfaced(log, vehicle)
    true = np.where(log.fresh, log.value - mission.truth.value, np.nan)[:, list(missions.RANGES)]
    np.testing.assert_array_equal(np.isnan(error), np.isnan(true))
    assert np.nanmax(np.abs(error - true)) < 8.0  # the fix is off by up to some metres, and the leader's word too
    faulty = (log.time >= 300) & (log.time < 400)
    assert np.nanmean(error[faulty, 0]) == pytest.approx(25.0, abs=2.0)


def test_injected_faults_are_in_the_errors() -> None:
    log = missions.healthy().log
    vehicle = cubature(log, followed("test", log), Filter()).vehicle
    clean = Lesson(log, surfaced(log, vehicle))
    bad = spoiled(clean, vehicle, 3.0, seed=1)
    ranges = list(missions.RANGES)
    np.testing.assert_allclose(
        (bad.error - clean.error)[log.fresh[:, ranges]],
        (bad.log.value - log.value)[:, ranges][log.fresh[:, ranges]],
        atol=1e-9,
    )
    assert 0.05 < np.mean(np.abs(bad.error[log.fresh[:, ranges]]) > 9) < 0.5


def _without(log: Log, *paths: str) -> Log:
    return log.select([c.path for c in log.channels if c.path not in paths])


@pytest.mark.parametrize(
    ("log", "words"),
    [
        (lambda: _without(missions.healthy().log, "leader1.range", "leader2.range"), "no sensor with a range"),
        (lambda: _without(missions.healthy().log, "gps.latitude"), "no position of the vehicle itself"),
        (lambda: sail(120.0, 1).log, "a leader with"),
    ],
)
def test_what_is_lacking_is_said(log, words) -> None:
    with pytest.raises(LogError, match=words):
        METHODS["cooperative"].build(log(), 0, SILENT)
    assert words in METHODS["cooperative"].lacks(log())
