"""Slow drifts of two real flights: the expected results, and that the short computation equals the whole monitor's."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.methods.height import drift_setting, drifting, ramp_glr, slope
from sensorfault.runtime.detect import detect
from sensorfault.simulation.flapping_wing import fly
from sensorfault_studies.multistep.beats import Beats, compared
from sensorfault_studies.multistep.flights import flight
from sensorfault_studies.multistep.slow_judge import HALF, RATES, Result, judge

SHORT = replace(slope.TEST, setting=drift_setting.Setting(window_s=30.0))  # for logs that are short
MUST = {"proto": (40.0, 20.0, 10.0), "thor": (110.0, 45.0, 25.0)}


def judged(beats: Beats, test: drift_setting.DriftTest) -> Result:
    return judge(beats, test, [test.setting])[0].judge(HALF)


@cache
def beats(name: str) -> Beats:
    return Beats.of(name, compared(flight(name)), drift_setting.DEFAULT)


@pytest.mark.real
@pytest.mark.parametrize("test", [slope.TEST, ramp_glr.TEST], ids=lambda test: test.name)
@pytest.mark.parametrize("name", MUST)
def test_real_ramps_are_found_in_time_and_nothing_else_is(
    name: str, test: drift_setting.DriftTest, real_data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    result = judged(beats(name), test)
    assert result.false == 0
    assert not result.missed.any()
    assert (result.delay.mean(axis=1) <= MUST[name]).all()
    assert result.delay.shape[1] > 10


def test_a_ramp_on_beats_is_a_ramp_on_fixes() -> None:
    """The study lays a ramp on the beats' differences; the whole monitor, on the whole log, alarms at the same time."""
    whole = compared(fly(300.0, seed=11, imu_hz=10.0, gnss_hz=5.0, barometer_hz=10.0, beat_hz=0.0).log)
    short = Beats.of("slope", whole, SHORT.setting)
    result = judged(short, SHORT)
    model = drifting.drift(whole.between(end_s=short.half), SHORT)
    assert result.limit == pytest.approx(model.summary["limit"], rel=1e-6)
    onset = short.half + 5.0
    for i, rate in enumerate(RATES):
        wrong = inject(whole, [Fault("drift", "gnss", "altitude", onset, 200.0, rate)]).log
        events = [e for e in detect(model, wrong).events if e.start_s >= onset and e.kind != "missing"]
        first = events[0].start_s if events else whole.time[-1]
        assert first - onset == pytest.approx(result.delay[i, 0], abs=1.1)
    assert result.missed[:, 0].tolist() == [True, False, False]  # 0.1 m/s is too slow for so short a window


def test_a_silent_half_promises_nothing() -> None:
    """Two heights that agree to the bit but for a step in the second half: one false event, said so."""
    time = np.arange(300.0)
    noise = np.random.default_rng(0).standard_normal(300)
    value = np.column_stack([100 + noise + 20.0 * (time > 220), np.full(300, 50.0)])
    channels = (Channel("altitude", "gnss", "m"), Channel("altitude", "barometer", "m"))
    log = Log(time, value, np.ones((300, 2), bool), channels, (Sensor("gnss", 1.0), Sensor("barometer", 1.0)))
    result = judged(Beats.of("slope", log, SHORT.setting), SHORT)
    assert result.false in (1, 2)  # noise may part the run
    assert result.ratio > 3
    assert 0.1 < result.far < 0.3
