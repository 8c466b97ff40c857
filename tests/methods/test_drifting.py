"""Recipes for a slow drift of a height: what they find, what stands in, and what they cannot be fitted on."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.height import cusum, mean_pair, ramp_glr, slope
from sensorfault.methods.height.drifting import drift
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.store import load, save
from sensorfault.simulation.flapping_wing import fly
from sensorfault.training.session import SILENT

RECIPES = (slope, mean_pair, ramp_glr, cusum)
ONSET_S = 600.0


@cache
def flight() -> Log:
    """15 min on the ticks on which a height comes; errors are bounded, so that what is healthy stays as it was."""
    result = fly(900.0, seed=7, imu_hz=10.0, gnss_hz=5.0, barometer_hz=10.0, beat_hz=0.0)
    paths = ["gnss.altitude", "gnss.down", "barometer.altitude"]
    log, truth = result.log.select(paths), result.truth.select(paths)
    random = np.random.default_rng(0).uniform(-1, 1, log.value.shape)
    wander = np.sin(log.time[:, None] / np.array([11.0, 1.0, 17.0]))
    return replace(log, value=truth.value + [1.0, 0.1, 1.0] * wander + [0.3, 0.1, 0.5] * random)


@cache
def fitted(name: str) -> Model:
    return METHODS[name].build(flight().between(end_s=400.0), 0, SILENT)


@pytest.mark.parametrize("module", RECIPES)
def test_a_slow_ramp_is_found_and_the_barometer_stands_in(module) -> None:
    log = flight().between(400.0)
    wrong = inject(log, [Fault("drift", "gnss", "altitude", ONSET_S, 200.0, 0.5)]).log
    result = detect(fitted(module.NAME), wrong)
    events = [event for event in result.events if event.kind != "missing"]
    assert events[0].sensor == "gnss"
    assert ONSET_S < events[0].start_s < ONSET_S + 60.0
    at = (log.time > ONSET_S + 100.0) & (log.time < ONSET_S + 120.0) & log.fresh[:, 0]
    assert np.abs(wrong.value[at, 0] - log.value[at, 0]).min() > 49.0
    assert np.nanmax(np.abs(result.repaired[at, 0] - log.value[at, 0])) < 15.0


@pytest.mark.parametrize("module", RECIPES)
def test_a_drift_that_has_stopped_is_not_healed(module) -> None:
    """The slope is over as soon as the window holds nothing but the offset; the height is as wrong as before."""
    log = flight().between(400.0)
    ramp = Fault("drift", "gnss", "altitude", ONSET_S, 50.0, 0.5)
    wrong = inject(log, [ramp, Fault("offset", "gnss", "altitude", ONSET_S + 50.0, 500.0, 25.0)]).log
    result = detect(fitted(module.NAME), wrong)
    late = log.time > ONSET_S + 60.0
    assert (result.channel[late, 0] == FAULT).all()
    assert np.nanmax(np.abs(result.repaired[late, 0] - log.value[late, 0])) < 10.0


@pytest.mark.parametrize("module", RECIPES)
def test_a_healthy_flight_has_no_event(module) -> None:
    result = detect(fitted(module.NAME), flight().between(400.0))
    assert not [event for event in result.events if event.kind != "missing"]


@pytest.mark.parametrize("module", RECIPES)
def test_saved_and_loaded_it_says_the_same(module, tmp_path: Path) -> None:
    log = flight().between(600.0, 760.0)
    path = tmp_path / "m.sensorfault"
    save(fitted(module.NAME), path)
    before, after = detect(fitted(module.NAME), log), detect(load(path), log)
    np.testing.assert_array_equal(before.traces[0].score, after.traces[0].score)
    np.testing.assert_array_equal(before.channel, after.channel)


def test_between_two_beats_the_verdict_stands() -> None:
    result = detect(fitted("slope"), flight().between(400.0))
    assert (result.channel[result.log.time > 545.0, 0] == 0).all()


def broken(log: Log) -> Log:
    """Without the barometer for 20 s in every 120."""
    gone = (log.time % 120.0 < 20.0)[:, None] & (np.arange(3) == 2)
    return replace(log, value=np.where(gone, np.nan, log.value), fresh=log.fresh & ~gone)


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (
            lambda log: log.select(["gnss.altitude", "gnss.down"]),
            "has no height of a barometer, but slope compares both",
        ),
        (lambda log: log.select(["barometer.altitude"]), "has no height of a satellite receiver"),
        (lambda log: log.between(end_s=150.0), "lasts 150 s, but slope needs 195 s"),
        (broken, "has no stretch of 130 s without a gap"),
        (lambda log: replace(log, fresh=log.fresh & False), "has 0 beats of 1 s"),
    ],
)
def test_what_it_cannot_be_fitted_on(damage: Callable[[Log], Log], said: str) -> None:
    with pytest.raises(LogError, match=said) as error:
        METHODS["slope"].build(damage(flight()), 0, SILENT)
    assert "\n" not in str(error.value)


def test_the_window_is_a_matter_of_setting() -> None:
    short = replace(slope.TEST, setting=replace(slope.TEST.setting, window_s=40.0))
    assert drift(flight().between(end_s=400.0), short).summary["limit"] > 1.5 * fitted("slope").summary["limit"]
