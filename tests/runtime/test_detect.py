"""A log and the same samples live: the same verdicts, the same events; and what may be believed."""

from copy import deepcopy
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import fitted
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.events.event import KINDS, Event
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import Live, detect
from sensorfault.runtime.result import Detection
from sensorfault.runtime.runners import StepResult


@cache
def compiled() -> Live:
    return Live(fitted.model())


def fresh_live() -> Live:
    """A copy: to compile takes two seconds."""
    return deepcopy(compiled())


@cache
def lived(told_what_is_fresh: bool) -> tuple[list[StepResult], list[Event]]:
    """The lying log pushed row by row."""
    live, log = fresh_live(), fitted.lying().log
    says = [
        live.push(time, value, fresh if told_what_is_fresh else None)
        for time, value, fresh in zip(log.time, log.value, log.fresh, strict=True)
    ]
    return says, sorted(live.events + live.open(), key=lambda event: event.start_s)


def named(events: "list[Event] | tuple[Event, ...]") -> list[tuple[object, ...]]:
    return [(e.start_s, e.end_s, e.subject, e.sensor, e.channel, e.kind, e.method) for e in events]


@pytest.mark.parametrize("told_what_is_fresh", [True, False])
def test_live_says_what_the_log_says(told_what_is_fresh: bool) -> None:
    says, _ = lived(told_what_is_fresh)
    found = fitted.found()
    np.testing.assert_array_equal(np.array([now.channel for now in says]), found.channel)
    np.testing.assert_array_equal(np.array([now.sensor for now in says]), found.sensor)
    np.testing.assert_array_equal(np.array([now.sample for now in says]), found.sample)


@pytest.mark.parametrize("told_what_is_fresh", [True, False])
def test_live_has_the_events_of_the_log(told_what_is_fresh: bool) -> None:
    """Held fixes included, also where nobody says which are new."""
    _, events = lived(told_what_is_fresh)
    found = fitted.found().events
    assert named(events) == named(found)
    for one, two in zip(events, found, strict=True):
        assert one.peak_score == pytest.approx(two.peak_score, rel=1e-9)
        assert one.limit == pytest.approx(two.limit, rel=1e-9)


def test_events_that_go_on_are_open_and_then_end() -> None:
    live, log = fresh_live(), fitted.lying().log.between(164.0, 170.0)
    open_at: dict[float, list[Event]] = {}
    for time, value in zip(log.time, log.value, strict=True):
        live.push(time, value)
        open_at[round(float(time), 2)] = live.open()
    (silent,) = open_at[167.0]
    assert (silent.sensor, silent.channel, silent.kind, silent.end_s) == ("gyro", None, "missing", None)
    assert open_at[164.9] == open_at[169.9] == []
    assert [event.kind for event in live.events] == ["missing"]


NAMED = [fault for fault in fitted.FAULTS if fault.kind not in ("scale", "delay")]  # these look like another kind


@pytest.mark.parametrize("fault", NAMED, ids=lambda fault: f"{fault.kind}:{fault.where}")
def test_faults_are_found_and_named(fault: Fault) -> None:
    """The first event of the kind in the fault's time names the sensor, and the channel where one was struck."""
    during = [e for e in fitted.found().events if fault.start_s - 0.01 <= e.start_s <= fault.end_s]
    mine = [event for event in during if event.kind == fault.kind]
    assert mine
    assert mine[0].sensor == fault.sensor
    assert fault.channel in (None, mine[0].channel)
    assert mine[0].start_s <= fault.start_s + 0.5


def test_a_healthy_log_has_no_events() -> None:
    healthy = detect(fitted.model(), fitted.unseen())
    assert healthy.events == ()
    assert not (healthy.channel == FAULT).any()
    assert (healthy.channel[:, :6] == OK).all()
    assert (healthy.channel[:, 6:] == UNKNOWN).all()  # a fix is watched for silence only
    np.testing.assert_array_equal(healthy.repaired, fitted.unseen().value)


def test_an_event_that_is_over_has_an_end() -> None:
    """Also the last one of a log."""
    lying = inject(fitted.unseen(), [Fault("offset", "gyro", "z", 110.0, 5.0, 20.0, sigmas=True)]).log
    assert [event.end_s for event in detect(fitted.model(), lying).events] == [pytest.approx(114.98)]


def held_often() -> Log:
    """Instead of a fix, two channels that are new in two rows of three: often enough to be judged."""
    log = fitted.rig()
    rows = np.arange(len(log))
    new = rows % 3 != 2
    value = log.value.copy()
    value[:, 6:] = log.value[rows - ~new][:, :2]
    fresh = log.fresh.copy()
    fresh[:, 6:] = new[:, None]
    return replace(log, value=value, fresh=fresh)


def test_live_knows_a_held_value_of_a_judged_sensor() -> None:
    """What is merely held is not tested, so it does not add to the repeats of a jam, live as in the log."""
    log = held_often()
    model = fit(log.between(end_s=fitted.LEARN_S), "elm-autoencoder", held_out=0.0)
    assert all(model.watched)
    rest = log.between(fitted.LEARN_S + 0.01, 110.0)  # its first row is new
    found, live = detect(model, rest), Live(model)
    for time, value, fresh, verdict in zip(rest.time, rest.value, rest.fresh, found.channel, strict=True):
        now = live.push(time, value)
        np.testing.assert_array_equal(now.valid[6:], fresh[6:])
        np.testing.assert_array_equal(now.channel, verdict)
    assert found.events == ()
    assert live.events == live.open() == []


def test_verdicts_are_three_valued_and_a_sensor_is_its_worst_channel() -> None:
    found = fitted.found()
    assert set(np.unique(found.channel)) == {OK, UNKNOWN, FAULT}
    for sensor, columns in enumerate((slice(0, 3), slice(3, 6), slice(6, 8))):
        np.testing.assert_array_equal(found.sensor[:, sensor], found.channel[:, columns].max(axis=1))
    absent = np.isnan(found.log.value)
    assert not (found.channel[absent] == OK).any()


def test_events_have_known_kinds_and_stand_in_order() -> None:
    events = fitted.found().events
    assert {event.kind for event in events} <= set(KINDS)
    assert [event.start_s for event in events] == sorted(event.start_s for event in events)
    assert all(event.end_s is None or event.end_s >= event.start_s for event in events)
    assert all(event.peak_score > event.limit for event in events if event.peak_score is not None)


def test_nothing_stands_in_for_what_is_missing() -> None:
    found = fitted.found()
    missing = np.isnan(found.log.value)
    assert missing.any()
    assert np.isnan(found.repaired[missing]).all()


def test_a_faulty_value_is_replaced_or_left_out() -> None:
    """A named channel never keeps the value it was named for: a stand-in for ten seconds, then nothing."""
    healthy = fitted.unseen()
    lying = inject(healthy, [Fault("offset", "gyro", "z", 110.0, 30.0, 20.0, sigmas=True)])
    found = detect(fitted.model(), lying.log)
    z = 2
    accused = found.channel[:, z] == FAULT
    assert accused[lying.mask[:, z]].mean() > 0.95
    rebuilt = accused & np.isfinite(found.repaired[:, z])
    assert not (found.repaired[rebuilt, z] == lying.log.value[rebuilt, z]).any()
    assert healthy.time[rebuilt].max() <= 110.0 + 10.0 + 1e-9
    assert healthy.time[rebuilt].max() >= 110.0 + 9.0
    late = accused & (healthy.time > 120.1)
    assert late.any()
    assert np.isnan(found.repaired[late, z]).all()
    # the stand-in is nearer to the truth than what was measured
    wrong, left = (np.abs(v[rebuilt, z] - healthy.value[rebuilt, z]).mean() for v in (lying.log.value, found.repaired))
    assert left < 0.2 * wrong


def test_held_values_stay_in_the_repaired_log() -> None:
    found = fitted.found()
    held = ~found.log.fresh & np.isfinite(found.log.value)
    assert held.any()
    np.testing.assert_array_equal(found.repaired[held], found.log.value[held])


def test_the_traces_are_the_tests_that_tested() -> None:
    found = fitted.found()
    assert found.traces[0].channel is None
    assert {trace.channel for trace in found.traces[1:]} == {c.path for c in fitted.CHANNELS[:6]}
    assert all(len(trace.score) == len(trace.limit) == len(found.log) for trace in found.traces)


def test_channels_in_another_order_and_others_beside_them() -> None:
    """A log may have its columns in any order, and more of them."""
    log = fitted.lying().log
    mixed = log.select(channel.path for channel in reversed(log.channels))
    again = detect(fitted.model(), mixed)
    assert again.events == fitted.found().events
    assert [c.path for c in again.log.channels] == [c.path for c in log.channels]


def test_progress_runs_from_nothing_to_all() -> None:
    result: list[float] = []
    detect(fitted.model(), fitted.rig(), result.append)
    assert result == sorted(result)
    assert len(result) == 2  # 10,000 rows, 8192 at a time
    assert result[-1] == 1.0


def test_a_log_is_judged_from_a_fresh_start_each_time() -> None:
    one, two = (detect(fitted.model(), fitted.lying().log) for _ in range(2))
    assert one.events == two.events
    assert one.repaired.tobytes() == two.repaired.tobytes()


def sentence(log: Log) -> str:
    with pytest.raises(LogError) as raised:
        detect(fitted.model(), log)
    text = str(raised.value)
    assert log.name in text
    assert "\n" not in text
    assert text.endswith(".")
    return text


def test_a_log_without_a_channel_of_the_model() -> None:
    log = fitted.unseen()
    lacking = log.select(channel.path for channel in log.channels if channel.path != "gyro.y")
    assert "gyro.y" in sentence(lacking)


def test_a_log_of_other_channels() -> None:
    log = fitted.unseen()
    other = replace(log, channels=tuple(replace(channel, name=f"wheel_{channel.name}") for channel in log.channels))
    assert "fit a model on this log" in sentence(other)


@pytest.mark.parametrize("factor", [0.2, 0.49, 2.1, 50.0])
def test_a_log_of_another_rate(factor: float) -> None:
    log = fitted.unseen()
    assert "fit a model on a log of the same rate" in sentence(replace(log, time=log.time * factor))


@pytest.mark.parametrize("factor", [0.55, 1.9])
def test_a_log_of_nearly_the_rate_will_do(factor: float) -> None:
    log = fitted.unseen().between(end_s=110.0)
    found = detect(fitted.model(), replace(log, time=log.time * factor))
    assert (found.channel[:, :6] != UNKNOWN).all()


def test_live_refuses_what_is_no_next_sample() -> None:
    live = fresh_live()
    row = fitted.unseen().value[0]
    live.push(1.0, row)
    for time, value in ((1.0, row), (0.5, row), (float("nan"), row), (1.02, row[:5]), (1.02, [*row, 0.0])):
        with pytest.raises(ValueError, match=r"^live: .*\.$"):
            live.push(time, value)
    assert live.push(1.02, row).sample == OK


def test_live_takes_lists_and_integers() -> None:
    live, log = fresh_live(), fitted.unseen().between(end_s=101.0)
    for time, value in zip(log.time, log.value, strict=True):
        assert live.push(float(time), value.tolist()).sample == OK


def test_one_row_is_judged() -> None:
    one: Detection = detect(fitted.model(), fitted.unseen().between(end_s=fitted.LEARN_S + 0.01))
    assert len(one.log) == 1
    assert one.events == ()
    assert one.sample[0] == OK


def without(start_s: float, end_s: float) -> Log:
    """The unseen log with a hole in it."""
    log = fitted.unseen()
    kept = (log.time <= start_s) | (log.time >= end_s)
    return replace(log, time=log.time[kept], value=log.value[kept], fresh=log.fresh[kept])


def test_a_hole_in_the_log_is_a_pause_and_nobodys_silence() -> None:
    found = detect(fitted.model(), without(110.02, 115.02))
    assert found.events == ()
    np.testing.assert_allclose(found.log.pauses, [[110.02, 115.02]])
    assert detect(fitted.model(), without(110.02, 110.52)).events == ()


def test_live_calls_a_hole_in_its_samples_missing() -> None:
    live, log = fresh_live(), without(110.02, 115.02).between(109.0, 117.0)
    for time, value in zip(log.time, log.value, strict=True):
        live.push(float(time), value)
    (hole,) = live.events
    assert (hole.sensor, hole.kind, hole.start_s) == (None, "missing", pytest.approx(110.02))


def test_a_frozen_axis_accuses_nobody_else() -> None:
    """Once: the joint test, which a frozen axis upsets too, was answered in the same round."""
    jammed = inject(fitted.unseen(), [Fault("frozen", "gyro", "y", 140.0, 5.0)]).log
    (event,) = detect(fitted.model(), jammed).events
    assert (event.sensor, event.channel, event.kind) == ("gyro", "y", "frozen")


def test_an_empty_log_is_a_sentence() -> None:
    with pytest.raises(LogError, match="no rows"):
        detect(fitted.model(), fitted.unseen().between(1e9))
