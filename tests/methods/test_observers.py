"""Both observers of a height as recipes: what they find, what stands in, what they cannot run on."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import flown
from sensorfault.core.verdicts import FAULT
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height import kinematic_observer, multistep_observer
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.store import load, save
from sensorfault.training.multistep import Schedule
from sensorfault.training.session import SILENT

LEARN_S, ONSET_S = 200.0, 240.0
HURRIED = Schedule(epochs=40, rate=1e-2)


@cache
def log() -> Log:
    return flown.flight(300.0)


@cache
def kinematic(source: str = "") -> Model:
    return kinematic_observer.build(log().between(end_s=LEARN_S), 0, SILENT, kinematic_observer.Setting(source=source))


@cache
def network() -> Model:
    setting = multistep_observer.Setting(schedule=HURRIED)
    return multistep_observer.build(log().between(end_s=LEARN_S), 0, SILENT, setting)


MODELS: dict[str, Callable[[], Model]] = {
    "kinematic": kinematic,
    "barometric": lambda: kinematic("barometric"),
    "network": network,
}
SLOPE = {"kinematic": 0.1, "barometric": 0.3, "network": 0.5}  # [m/s]


@pytest.mark.parametrize("name", MODELS)
def test_a_slow_drift_is_found_and_health_is_not(name: str) -> None:
    unseen = log().between(LEARN_S)
    assert not detect(MODELS[name](), unseen).events
    drift = Fault("drift", "gnss", "altitude", ONSET_S, 30.0, SLOPE[name])
    found = detect(MODELS[name](), inject(unseen, [drift]).log)
    accused = found.channel[:, flown.HEIGHT] == FAULT
    assert not accused[unseen.time < ONSET_S].any()
    first = unseen.time[accused][0]
    assert first < ONSET_S + 25.0
    assert {event.sensor for event in found.events} == {"gnss"}


@pytest.mark.parametrize("name", MODELS)
def test_what_stands_in_is_nearer_than_what_is_measured(name: str) -> None:
    unseen = log().between(LEARN_S)
    step = Fault("offset", "gnss", "altitude", ONSET_S, 8.0, 6.0)
    found = detect(MODELS[name](), inject(unseen, [step]).log)
    wrong = (unseen.time >= ONSET_S) & (unseen.time < ONSET_S + 8.0)
    assert (found.channel[wrong, flown.HEIGHT] == FAULT).all()
    assert np.abs(found.repaired[wrong, flown.HEIGHT] - unseen.value[wrong, flown.HEIGHT]).max() < 3.0


def test_spans_that_the_log_cannot_show_are_left_out() -> None:
    """Of 24 s nothing can be said of a minute."""
    model = kinematic_observer.build(flown.flight(24.0), 0, SILENT)
    assert model.summary["steps"] == [1, 5, 12, 25, 50]
    assert kinematic().summary["steps"] == [1, 5, 12, 25, 50, 150, 300]
    assert [test for test, _ in model.tests][:2] == ["roll-out over 0.2 s", "roll-out over 1 s"]


def test_a_bank_of_networks_is_one_network() -> None:
    """Given in seconds; each member has its own test and limit."""
    setting = multistep_observer.Setting(spans_s=(2.4, 0.2), schedule=HURRIED)
    model = multistep_observer.build(log().between(end_s=LEARN_S), 0, SILENT, setting)
    assert model.summary["steps"] == [1, 12]
    assert [test for test, _ in model.tests] == ["roll-out over 0.2 s", "roll-out over 2.4 s"]
    unseen = log().between(LEARN_S)
    one, many = detect(network(), unseen).traces, detect(model, unseen).traces
    np.testing.assert_allclose(many[1].score, one[0].score, rtol=1e-9)
    assert np.nanmean(many[0].limit) < np.nanmean(many[1].limit)


def test_heights_on_a_faster_clock_are_the_same_heights() -> None:
    fast = flown.flight(120.0, hz=25.0)
    fixes = fast.without(np.flatnonzero(~fast.fresh[:, flown.HEIGHT]))
    slow = replace(fixes, sensors=tuple(replace(sensor, period_s=flown.FIX_S) for sensor in fast.sensors))
    on_both = [kinematic_observer.build(one, 0, SILENT) for one in (fast, slow)]
    steps = [np.asarray(model.monitor.residual.steps) for model in on_both]
    np.testing.assert_array_equal(*steps)
    drift = Fault("drift", "gnss", "altitude", 60.0, 30.0, 0.3)
    result = [detect(on_both[0], inject(one, [drift]).log) for one in (fast,)]
    score = result[0].traces[2].score
    assert np.isfinite(score[:: round(flown.FIX_S * 25)][13:]).all()
    assert np.isnan(np.delete(score, np.s_[:: round(flown.FIX_S * 25)])).all()


def test_as_printed_both_weights_are_one() -> None:
    setting = multistep_observer.Setting(printed=True, schedule=HURRIED)
    threshold = multistep_observer.build(log().between(end_s=LEARN_S), 0, SILENT, setting).monitor.branches[0].threshold
    assert (float(threshold.a[0]), float(threshold.b[0])) == (1.0, 1.0)
    assert float(threshold.chi_square) == pytest.approx(6.6349, abs=1e-4)
    fitted = network().monitor.branches[0].threshold
    assert float(fitted.a[0]) == float(fitted.b[0]) > 1.0


@pytest.mark.parametrize("name", MODELS)
def test_saved_and_loaded(name: str, tmp_path: Path) -> None:
    unseen = log().between(LEARN_S, LEARN_S + 20.0)
    save(MODELS[name](), tmp_path / "plane.sensorfault")
    again = detect(load(tmp_path / "plane.sensorfault"), unseen)
    for one, two in zip(detect(MODELS[name](), unseen).traces, again.traces, strict=True):
        assert one.score.tobytes() == two.score.tobytes()


def sentence(build: Callable[[], object]) -> str:
    with pytest.raises(LogError) as raised:
        build()
    text = str(raised.value)
    assert text.endswith(".")
    assert "\n" not in text
    return text


def test_what_they_cannot_run_on() -> None:
    whole, build = log(), kinematic_observer.build
    for one in (kinematic_observer.build, multistep_observer.build):
        assert "no altitude or height" in sentence(lambda: one(whole.select(["gnss.down"]), 0, SILENT))  # noqa: B023
    alone = whole.select(["gnss.altitude"])
    assert "neither a vertical speed nor a second height" in sentence(lambda: build(alone, 0, SILENT))
    assert "no vertical speed, pitch, throttle" in sentence(lambda: multistep_observer.build(alone, 0, SILENT))
    inertial = kinematic_observer.Setting(source="inertial")
    assert "no inertial vertical speed" in sentence(lambda: build(whole, 0, SILENT, inertial))
    odd = kinematic_observer.Setting(source="sonar")
    assert "take one of receiver, inertial, barometric" in sentence(lambda: build(whole, 0, SILENT, odd))
    minute = kinematic_observer.Setting(spans_s=(60.0,))
    assert "0 runs of 300 heights without a gap" in sentence(lambda: build(flown.flight(50.0), 0, SILENT, minute))
    lone = multistep_observer.Setting(spans_s=(100.0,), schedule=HURRIED)
    assert "no 500 heights in a row without a gap" in sentence(lambda: multistep_observer.build(whole, 0, SILENT, lone))
    short = whole.between(end_s=14.0)
    assert "measurements of gnss.altitude" in sentence(lambda: multistep_observer.build(short, 0, SILENT))
