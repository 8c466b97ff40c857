"""The way of the last second: a frozen position is found, and the newest positions are not looked at."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position import lstm_displacement
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.simulation.road import drive
from sensorfault.training.gradient import Plan
from sensorfault.training.session import SILENT

SIZE = lstm_displacement.Size((4,), Plan(epochs=5, batch=128, rate=0.01))
POSITION = ("gnss.latitude", "gnss.longitude")


@cache
def log() -> Log:
    return drive(120.0, seed=3).log


@cache
def model() -> Model:
    return lstm_displacement.build(log(), 0, SILENT, SIZE)


def frozen() -> tuple[Log, slice]:
    """The position stands still for five seconds while the car is at its fastest."""
    speed = np.convolve(log().value[:, log().index("gnss.speed")], np.ones(250), "valid")
    start = int(np.argmax(speed[500:])) + 500
    span = slice(start, start + 250)
    value = log().value.copy()
    for path in POSITION:
        value[span, log().index(path)] = value[start, log().index(path)]
    return replace(log(), value=value), span


def test_a_frozen_position_is_found() -> None:
    assert detect(model(), log()).events == ()
    jammed, span = frozen()
    events = detect(model(), jammed).events
    assert events
    assert {event.sensor for event in events} == {"gnss"}
    assert log().time[span.start] < events[0].start_s < log().time[span.start] + 2.0


def test_the_newest_second_of_the_position_has_no_say_in_what_is_expected() -> None:
    result, clean = (replay_log(uncalibrated(model().monitor), one) for one in (frozen()[0], log()))
    jammed, span = frozen()
    columns = [log().index(path) for path in POSITION]
    # what was expected = what was measured - what was left of it
    soon = slice(span.start + 1, span.start + 40)
    expected = (jammed.value - result.residual)[soon][:, columns]
    want = (log().value - clean.residual)[soon][:, columns]
    valid = result.valid[soon][:, columns]
    assert valid.any()
    np.testing.assert_allclose(expected[valid], want[valid], rtol=0, atol=1e-12)


def test_what_it_cannot_be_fitted_on_is_said() -> None:
    for bad, said in (
        (log().select(POSITION), "neither gyro, accelerometer nor velocity"),
        (log().select(["gyro.x", "gnss.speed"]), "has no latitude, longitude"),
    ):
        with pytest.raises(LogError, match=said) as raised:
            lstm_displacement.build(bad, 0, SILENT, SIZE)
        assert str(raised.value).endswith(".")
