"""Events made by hand against faults made by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluation.detections import TICK_S, detection, event, quiet
from sensorfault.evaluation.judge import GRACE_S, Outcome, covered_s, judge, noticed_s
from sensorfault.faults.fault import Fault

FAULT = Fault("offset", "gyro", "x", 100.0, 10.0, 5.0)


def outcome(*events: object, fault: Fault = FAULT) -> Outcome:
    (one,) = judge(detection(events), [fault]).outcomes  # type: ignore[arg-type]
    return one


def test_an_event_within_the_fault_finds_it() -> None:
    one = outcome(event(103.0, 104.0))
    assert one.found
    assert one.delay_s == pytest.approx(3.0)
    assert (one.sensor_right, one.channel_right, one.kind_right) == (True, True, True)
    assert one.named == event(103.0, 104.0)


def test_nothing_found() -> None:
    one = outcome()
    assert not one.found
    assert math.isnan(one.delay_s)
    assert (one.sensor_right, one.channel_right, one.kind_right, one.named) == (False, False, False, None)


@pytest.mark.parametrize(
    ("start_s", "found"),
    [
        *((50.0, False), (99.0, False), (99.94, False)),  # before the fault nobody can know of it
        *((99.96, True), (100.0, True)),  # half a tick is rounding
        *((110.0, True), (110.0 + GRACE_S, True), (110.01 + GRACE_S, False), (500.0, False)),
    ],
)
def test_only_an_event_that_begins_during_the_fault_counts(start_s: float, found: bool) -> None:
    """However long it lasts: an alarm that was going on at onset has found nothing."""
    for end_s in (start_s, start_s + 1.0, 900.0, None):
        judgement = judge(detection([event(start_s, end_s)]), [FAULT])
        assert judgement.outcomes[0].found is found
        assert len(judgement.false_alarms) == (not found)


def test_delay_is_never_negative() -> None:
    assert outcome(event(99.96)).delay_s == 0.0


def test_the_first_alarm_counts() -> None:
    """A right answer later does not mend a wrong one before."""
    one = outcome(event(105.0), event(101.0, sensor="gnss", channel="east", kind="frozen"))
    assert one.delay_s == pytest.approx(1.0)
    assert (one.sensor_right, one.channel_right, one.kind_right) == (False, False, False)


def test_of_two_at_once_the_one_that_names_a_sensor() -> None:
    one = outcome(event(101.0, sensor=None, channel=None, kind="unknown"), event(101.0))
    assert one.sensor_right


@pytest.mark.parametrize(
    ("said", "right"),
    [
        (event(101.0), (True, True, True)),
        (event(101.0, channel="y"), (True, False, True)),
        (event(101.0, channel=None), (True, False, True)),
        (event(101.0, sensor="gnss", channel="x"), (False, False, True)),
        (event(101.0, kind="drift"), (True, True, False)),
        (event(101.0, sensor=None, channel=None, kind="unknown"), (False, False, False)),
    ],
)
def test_sensor_channel_and_kind(said: object, right: tuple[bool, bool, bool]) -> None:
    one = outcome(said)
    assert (one.sensor_right, one.channel_right, one.kind_right) == right


def test_any_channel_is_right_where_all_were_struck() -> None:
    whole = replace(FAULT, channel=None)
    assert all(outcome(event(101.0, channel=c), fault=whole).channel_right for c in ("x", "y", None))
    assert not outcome(event(101.0, sensor="gnss"), fault=whole).channel_right


def test_a_silence_is_noticed_when_it_has_lasted_too_long() -> None:
    """Its event begins in the past: nobody could know then."""
    miss = Fault("missing", "gyro", None, 100.0, 10.0)
    said = event(100.1, channel=None, kind="missing", limit=0.35)
    assert noticed_s(said) == pytest.approx(100.45)
    assert outcome(said, fault=miss).delay_s == pytest.approx(0.45)
    assert noticed_s(event(100.0)) == 100.0
    assert noticed_s(event(100.0, kind="missing", limit=None)) == 100.0


def test_a_spike() -> None:
    spike = Fault("spike", "gyro", "x", 100.0, 0.0, 5.0)
    assert outcome(event(100.0, 100.0, kind="spike"), fault=spike).kind_right
    assert outcome(event(100.0 + GRACE_S), fault=spike).found
    assert not outcome(event(100.1 + GRACE_S), fault=spike).found


def test_false_alarms_an_hour_of_healthy_time() -> None:
    judgement = judge(detection([event(50.0), event(105.0), event(500.0), event(600.0, None)]), [FAULT])
    assert [e.start_s for e in judgement.false_alarms] == [50.0, 500.0, 600.0]
    assert judgement.healthy_hours == pytest.approx((1000.0 - 10.0 - GRACE_S) / 3600)
    assert judgement.false_alarms_per_hour == pytest.approx(3 * 3600 / 989)


def test_faults_that_overlap_are_counted_once() -> None:
    later = replace(FAULT, sensor="gnss", channel="east", start_s=105.0)
    judgement = judge(detection([event(106.0)]), [FAULT, later])
    assert judgement.healthy_hours == pytest.approx((1000.0 - 15.0 - GRACE_S) / 3600)
    assert judgement.false_alarms == ()


def test_where_nothing_was_healthy_there_is_no_rate() -> None:
    judgement = judge(detection([event(10.0)]), [replace(FAULT, start_s=0.0, duration_s=1000.0)])
    assert judgement.healthy_hours == 0
    assert math.isnan(judgement.false_alarms_per_hour)


def test_without_faults_all_alarms_are_false() -> None:
    judgement = judge(detection([event(1.0), event(2.0)]), [])
    assert judgement.outcomes == ()
    assert judgement.false_alarms_per_hour == pytest.approx(2 * 3.6)


def test_recovery_error_in_healthy_sigmas() -> None:
    """By hand: a bias of 6 on a channel of sigma 1, of which the stand-in leaves 1.5; NaN leaves nothing."""
    clean = quiet()
    struck = (clean.time >= 100.0) & (clean.time <= 110.0)
    faulty, repaired = clean.value.copy(), clean.value.copy()
    faulty[struck, 0] += 6.0
    repaired[struck, 0] += 1.5
    lying = replace(clean, value=faulty)
    sigma = clean.value[:, 0].std()
    (one,) = judge(detection([], lying, repaired), [FAULT], clean).outcomes
    assert one.error_before == pytest.approx(6.0 / sigma)
    assert one.error_after == pytest.approx(1.5 / sigma)
    repaired[struck & (clean.time > 101.0), 0] = np.nan
    (one,) = judge(detection([], lying, repaired), [FAULT], clean).outcomes
    assert one.error_after == pytest.approx(1.5 / sigma)
    repaired[struck, 0] = np.nan
    (one,) = judge(detection([], lying, repaired), [FAULT], clean).outcomes
    assert math.isnan(one.error_after)
    (one,) = judge(detection([], lying, repaired), [FAULT]).outcomes
    assert math.isnan(one.error_before)


def test_recovery_error_of_a_whole_sensor_and_of_a_part_of_the_log() -> None:
    """`clean` may be longer than what was judged, and have its channels in another order."""
    clean = quiet().select(["gnss.east", "gyro.y", "gyro.x"])
    part = quiet().between(50.0, 200.0)
    struck = (part.time >= 100.0) & (part.time <= 110.0)
    faulty = part.value.copy()
    faulty[struck, :2] += [6.0, 8.0]
    (one,) = judge(detection([], replace(part, value=faulty)), [replace(FAULT, channel=None)], clean).outcomes
    sx, sy = part.value[:, 0].std(), part.value[:, 1].std()
    assert one.error_before == pytest.approx(np.sqrt(((6 / sx) ** 2 + (8 / sy) ** 2) / 2))


SPANS = st.lists(st.tuples(st.integers(0, 50), st.integers(0, 50)).map(sorted).map(tuple))


@given(SPANS)
@settings(deadline=None)
def test_the_union_of_windows_by_counting_seconds(spans: list[tuple[int, int]]) -> None:
    seconds = {second for start, end in spans for second in range(start, end)}
    assert covered_s([(float(start), float(end)) for start, end in spans]) == len(seconds)


@given(st.lists(st.floats(0, 990), max_size=20), st.lists(st.tuples(st.floats(0, 900), st.floats(0, 90)), max_size=6))
@settings(deadline=None)
def test_each_event_is_a_finding_or_a_false_alarm(starts: list[float], spans: list[tuple[float, float]]) -> None:
    """By brute force: an event is false exactly if it begins within no fault; a fault is found exactly if one does."""
    faults = [Fault("offset", "gyro", "x", start, length, 1.0) for start, length in spans]
    events = [event(start) for start in starts]
    judgement = judge(detection(events), faults)

    def within(begun: float, fault: Fault) -> bool:
        return fault.start_s - TICK_S / 2 <= begun <= fault.start_s + fault.duration_s + GRACE_S

    tick = detection().log.period_s  # of floats: a hair off TICK_S
    near = any(abs(s - f.start_s + tick / 2) < 1e-6 for s in starts for f in faults)
    if near:
        return
    assert [e.start_s for e in judgement.false_alarms] == [
        s for s in starts if not any(within(s, fault) for fault in faults)
    ]
    assert [one.found for one in judgement.outcomes] == [any(within(s, fault) for s in starts) for fault in faults]
    for one in judgement.outcomes:
        if one.found:
            first = min(s for s in starts if within(s, one.fault))
            assert one.delay_s == pytest.approx(max(0.0, first - one.fault.start_s), abs=1e-9)
