"""Two heights disagree and no third source can decide: the fault is nobody's, and says how far it is over its limit."""

from functools import cache

import numpy as np
import pytest

import flown
from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.methods.height.height_agreement import build
from sensorfault.runtime.detect import Live, detect
from sensorfault.runtime.extractor import EventExtractor
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_on
from sensorfault.runtime.result import Detection
from sensorfault.training.session import SILENT

pytestmark = pytest.mark.usefixtures("hasty")

FITTED_S, ONSET_S, LASTS_S = 300.0, 380.0, 40.0


@cache
def heights() -> Log:
    return flown.flight(520.0, hz=1.0).select(["gnss.altitude", "barometer.altitude"])


@cache
def model() -> Model:
    return build(heights().between(end_s=FITTED_S), 0, SILENT)


@cache
def lying() -> Log:
    ramp = Fault("drift", "gnss", "altitude", ONSET_S, LASTS_S, 1.0)
    return inject(heights().between(FITTED_S), [ramp]).log


@cache
def whole() -> Detection:
    return detect(model(), lying())


def of_nobody(events: tuple[Event, ...] | list[Event]) -> list[Event]:
    assert events
    assert {(event.subject, event.sensor, event.channel, event.kind) for event in events} == {
        ("sensor", None, None, "unknown")
    }
    return list(events)


def test_it_carries_the_largest_excess_of_all_tests() -> None:
    found, time = whole(), lying().time
    for event in of_nobody(found.events):
        during = (time >= event.start_s) & (time <= (event.end_s or np.inf))
        over = [np.nanmax(trace.score[during] / trace.limit[during]) for trace in found.traces]
        assert event.peak_score is not None
        assert event.limit is not None
        assert event.peak_score > event.limit
        assert event.peak_score / event.limit == pytest.approx(max(over))


def close(one: list[Event], two: list[Event]) -> None:
    assert [(event.start_s, event.end_s) for event in one] == [(event.start_s, event.end_s) for event in two]
    assert [event.peak_score for event in one] == pytest.approx([event.peak_score for event in two], rel=1e-9)
    assert [event.limit for event in one] == pytest.approx([event.limit for event in two], rel=1e-9)


def test_live_says_the_same() -> None:
    live, log = Live(model()), lying()
    for time, value, fresh in zip(log.time, log.value, log.fresh, strict=True):
        live.push(time, value, fresh)
    close(of_nobody(live.events + live.open()), of_nobody(whole().events))


@pytest.mark.parametrize("cut_s", [ONSET_S - 20.0, ONSET_S + LASTS_S / 2, ONSET_S + LASTS_S])
def test_part_by_part_says_the_same(cut_s: float) -> None:
    """The fault may lie across the cut, its peak in either part."""
    extractor, state = EventExtractor(model()), model().monitor.init()
    for part in (lying().between(end_s=cut_s), lying().between(cut_s)):
        state, result = replay_on(model().monitor, state, part)
        extractor.take(part, result)
    close(of_nobody(extractor.events), of_nobody(whole().events))
