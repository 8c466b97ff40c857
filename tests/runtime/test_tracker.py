"""Rows made by hand, and the events that they mean."""

from dataclasses import replace

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.events.event import Event
from sensorfault.runtime.event_context import EventContext
from sensorfault.runtime.fault_tracker import QUIET_S
from sensorfault.runtime.model import MOTION
from sensorfault.runtime.runners import StepResult
from sensorfault.runtime.silence_tracker import GAP_S
from sensorfault.runtime.tracker import Tracker

TICK_S = 0.02
NAMES = (("gyro", "x"), ("gyro", "y"), ("gnss", "east"), ("gnss", "north"))
PERIOD_S = np.array([0.02, 0.02, 0.1, 0.1])
WATCH = EventContext(
    method="hand",
    sensor=tuple(sensor for sensor, _ in NAMES),
    channel=tuple(channel for _, channel in NAMES),
    period_s=PERIOD_S,
    silent_after_s=3 * PERIOD_S + TICK_S / 2,
    sigma=np.full(4, 0.1),
    tests=(None, (1,)),
    tick_s=TICK_S,
)
START_S = 100.0
X, Y, EAST, NORTH = range(4)
BEFORE_HOLE = 51  # ticks, the last of them with a fix


class Drive:
    """Ticks of 20 ms, healthy unless told otherwise; every event that ended is in `ended`."""

    def __init__(self, watch: EventContext = WATCH) -> None:
        self.tracker = Tracker(watch)
        self.ended: list[Event] = []
        self.time: float | None = None
        self.received = np.full(4, -1e12)
        self.count = 0

    def tick(
        self,
        accused: dict[int, float] | None = None,
        absent: tuple[int, ...] = (),
        gap_s: float = TICK_S,
        sample: int | None = None,
        score: float | None = None,
        measured: float | None = None,
        motion: int = UNKNOWN,
    ) -> None:
        """One tick `gap_s` after the last; `accused`: residual by channel. The fix comes with every fifth."""
        accused = accused or {}
        now = START_S if self.time is None else self.time + gap_s
        gap_s = 0.0 if self.time is None else now - self.time
        comes = np.array([True, True, self.count % 5 == 0, self.count % 5 == 0])
        comes[list(absent)] = False
        verdict = np.where([c in accused for c in range(4)], FAULT, OK).astype(np.int8)
        verdict[~comes & (verdict == OK)] = UNKNOWN
        residual = np.zeros(4)
        residual[list(accused)] = list(accused.values())
        value = np.where(comes, self.count + residual, np.nan)
        if measured is not None:
            value[list(accused)] = measured
        top = score if score is not None else (5.0 if accused else 0.1)
        result = StepResult(
            channel=verdict,
            sensor=np.array([verdict[:2].max(), verdict[2:].max()]),
            sample=(FAULT if accused else OK) if sample is None else sample,
            motion=motion,
            score=np.array([top, np.nan]),
            limit=np.array([2.0, 7.0]),
            value=value,
            residual=residual,
            valid=comes,
            silence=now - self.received,
        )
        self.ended += self.tracker.push(now, gap_s, value, result)
        self.received[comes] = now
        self.time = now
        self.count += 1

    def run(self, ticks: int, **result: object) -> "Drive":
        for _ in range(ticks):
            self.tick(**result)  # type: ignore[arg-type]
        return self

    def quiet(self) -> "Drive":
        """Long enough for whatever is open to end."""
        return self.run(round(QUIET_S / TICK_S) + 2)

    def only(self) -> Event:
        assert self.tracker.open() == []
        assert not self.tracker.busy()
        (event,) = self.ended
        return event


def at(tick: int) -> object:
    return pytest.approx(START_S + tick * TICK_S, abs=1e-6)


def test_a_healthy_drive_has_no_events() -> None:
    drive = Drive().run(300)
    assert drive.ended == drive.tracker.open() == []
    assert not drive.tracker.busy()


def test_one_event_from_first_to_last_faulty_sample() -> None:
    drive = Drive().run(50).run(30, accused={X: 4.0})
    (open_,) = drive.tracker.open()
    assert drive.tracker.busy()
    assert drive.ended == []
    assert (open_.start_s, open_.end_s) == (at(50), None)
    event = drive.quiet().only()
    assert event == replace(open_, end_s=event.end_s)
    assert event.end_s == at(79)
    assert (event.sensor, event.channel, event.kind, event.subject, event.method) == (
        *("gyro", "x", "offset", "sensor", "hand"),
    )


def test_a_motion_that_cannot_be_is_no_sensors_fault() -> None:
    drive = Drive().run(50, motion=OK).run(30, motion=FAULT, score=9.0)
    (open_,) = drive.tracker.open()
    assert (open_.start_s, open_.end_s, open_.subject, open_.sensor, open_.kind) == (
        *(at(50), None, "motion", None, "unknown"),
    )
    assert open_.peak_score is None  # the score was that of another test
    event = drive.quiet().only()
    assert event == replace(open_, end_s=event.end_s)
    assert event.end_s == at(79)


def test_it_ends_only_after_quiet_time() -> None:
    drive = Drive().run(10, accused={X: 4.0})
    drive.run(round(QUIET_S / TICK_S) - 1)
    assert drive.ended == []
    assert drive.run(3).only().end_s == at(9)


def test_alarms_close_together_are_one_event_and_far_apart_two() -> None:
    close = Drive().run(5, accused={X: 4.0}).run(60).run(5, accused={X: 4.0}).quiet()
    assert (close.only().start_s, close.only().end_s) == (at(0), at(69))
    far = Drive().run(5, accused={X: 4.0}).run(120).run(5, accused={X: 4.0}).quiet()
    assert [(event.start_s, event.end_s) for event in far.ended] == [(at(0), at(4)), (at(125), at(129))]


def test_peak_and_limit_are_those_of_the_worst_sample() -> None:
    drive = Drive().run(1, accused={X: 4.0}, score=3.0).run(1, accused={X: 4.0}, score=40.0)
    drive.run(3, accused={X: 4.0}, score=6.0)
    event = drive.quiet().only()
    assert (event.peak_score, event.limit) == (40.0, 2.0)


def test_a_verdict_that_is_only_held_has_no_score() -> None:
    event = Drive().run(5, accused={X: 4.0}, score=0.1).quiet().only()
    assert event.peak_score is None
    assert event.limit is None


@pytest.mark.parametrize(("ticks", "kind"), [(1, "spike"), (2, "spike"), (40, "offset")])
def test_the_kind_comes_from_the_measurements_while_it_lasts(ticks: int, kind: str) -> None:
    """Healthy measurements after the last accusation do not water it down."""
    assert Drive().run(20).run(ticks, accused={X: 4.0}).quiet().only().kind == kind


def test_healthy_looking_samples_within_an_event_count() -> None:
    """Accused at every fourth sample only, the channel itself never changes: a jam."""
    drive = Drive()
    for _ in range(12):
        drive.run(1, accused={X: 4.0}, measured=1.0)
    assert drive.quiet().only().kind == "frozen"


def test_each_measurement_counts_once() -> None:
    """Up, twice as long down, up again: no mean and no slope, unless the first ones are counted more often."""
    drive = Drive()
    for up in (True, False, False, True):
        drive.run(10, accused={X: 4.0 if up else -4.0})
    assert drive.quiet().only().kind == "noise"


def test_two_channels_of_a_sensor_with_the_same_fault_are_one_event() -> None:
    event = Drive().run(1, accused={X: 4.0}, score=3.0).run(30, accused={X: 4.0, Y: -5.0}).quiet().only()
    assert (event.sensor, event.channel, event.kind) == ("gyro", None, "offset")
    assert event.start_s == at(0)
    assert event.end_s == at(30)
    assert event.peak_score == 5.0


def test_they_are_one_event_also_while_it_goes_on() -> None:
    (event,) = Drive().run(30, accused={X: 4.0, Y: 4.0}).tracker.open()
    assert (event.sensor, event.channel, event.end_s) == ("gyro", None, None)


def test_channels_that_one_test_accuses_are_one_event_of_the_clearest_kind() -> None:
    """A position is off mostly to the north, and its east a little; the test of both is the third."""
    fix = replace(
        WATCH, channel=("latitude", "longitude", "speed", "course"), sensor=("gnss",) * 4, tests=(None, (0, 1))
    )
    drive = Drive(fix).run(50)
    for _ in range(30):
        drive.run(1, accused={X: 4.0, Y: 0.1})
    event = drive.quiet().only()
    assert (event.sensor, event.channel, event.kind) == ("gnss", "latitude, longitude", "offset")
    apart = Drive(fix).run(50).run(5, accused={X: 4.0}).run(30, accused={X: 4.0, Y: 0.1}).quiet()
    assert [event.channel for event in apart.ended] == ["latitude", "longitude"]


def test_two_channels_with_different_faults_are_two_events() -> None:
    drive = Drive()
    for i in range(60):
        drive.run(1, accused={X: 4.0, Y: i * 0.2})
    drive.quiet()
    assert {(event.channel, event.kind) for event in drive.ended} == {("x", "offset"), ("y", "drift")}


def test_channels_of_different_sensors_are_not_merged() -> None:
    drive = Drive().run(40, accused={X: 4.0, EAST: 4.0}).quiet()
    assert {(event.sensor, event.channel) for event in drive.ended} == {("gyro", "x"), ("gnss", "east")}


def test_one_of_two_channels_keeps_its_name() -> None:
    assert Drive().run(30, accused={Y: 4.0}).quiet().only().channel == "y"


def test_a_faulty_sample_without_a_sensor() -> None:
    drive = Drive().run(10).run(5, sample=FAULT, score=9.0).quiet()
    event = drive.only()
    assert (event.sensor, event.channel, event.kind) == (None, None, "unknown")
    assert (event.start_s, event.end_s) == (at(10), at(14))
    assert (event.peak_score, event.limit) == (9.0, 2.0)


NOBODY = {"sample": FAULT}


def test_a_fault_of_nobody_has_the_peak_of_the_test_that_exceeded_its_limit_most() -> None:
    """Also where every test knows whom it examines: it is over, and none of them could be named."""
    drive = Drive(replace(WATCH, tests=((X, EAST), (Y,)))).run(10)
    drive.run(3, **NOBODY, score=6.0).run(1, **NOBODY, score=9.0).run(2, **NOBODY, score=3.0)
    (open_,) = drive.tracker.open()
    event = drive.quiet().only()
    for one in (open_, event):
        assert (one.sensor, one.kind, one.peak_score, one.limit) == (None, "unknown", 9.0, 2.0)


def test_a_fault_of_nobody_takes_no_peak_from_a_test_of_the_motion() -> None:
    event = Drive(replace(WATCH, tests=(MOTION, (Y,)))).run(5, **NOBODY, score=6.0).quiet().only()
    assert (event.subject, event.sensor, event.peak_score) == ("sensor", None, None)


def test_the_peaks_of_a_named_fault_and_one_of_nobody_are_apart() -> None:
    """A channel is accused for a while, then the fault goes on and nobody can be named."""
    drive = Drive(replace(WATCH, tests=((X,), (Y,)))).run(5, accused={X: 4.0}, score=6.0).run(5, **NOBODY, score=40.0)
    drive.quiet()
    assert [(event.sensor, event.peak_score) for event in drive.ended] == [("gyro", 6.0), (None, 40.0)]


def test_a_sensor_that_falls_silent_is_missing_from_when_it_should_have_spoken() -> None:
    drive = Drive().run(50)
    drive.run(100, absent=(X, Y))
    (open_,) = drive.tracker.open()
    assert (open_.sensor, open_.channel, open_.kind, open_.end_s) == ("gyro", None, "missing", None)
    assert open_.start_s == at(50)
    assert open_.peak_score == pytest.approx(100 * TICK_S)  # since it last spoke, as the limit is
    assert open_.limit == pytest.approx(WATCH.silent_after_s[X])
    event = drive.run(2).only()
    assert (event.start_s, event.end_s) == (at(50), at(150))  # until it speaks again


def test_a_silence_of_what_is_allowed_is_none() -> None:
    assert Drive().run(50).run(2, absent=(X, Y)).run(50).ended == []  # three periods from one value to the next
    event = Drive().run(50).run(3, absent=(X, Y)).run(50).only()
    assert event.kind == "missing"
    assert event.peak_score > event.limit


def test_a_slow_sensor_may_be_silent_for_longer() -> None:
    drive = Drive().run(51)  # a fix with the last tick
    drive.run(15, absent=(EAST, NORTH))
    assert not drive.tracker.busy()
    drive.run(40, absent=(EAST, NORTH))
    (event,) = drive.tracker.open()
    assert (event.sensor, event.channel, event.start_s) == ("gnss", None, at(55))


def test_a_channel_that_falls_silent_alone_is_named() -> None:
    event = Drive().run(50).run(20, absent=(Y,)).run(10).only()
    assert (event.sensor, event.channel, event.kind) == ("gyro", "y", "missing")


def test_a_silence_that_goes_on_at_the_end_stays_open() -> None:
    drive = Drive().run(50).run(500, absent=(X, Y))
    assert drive.ended == []
    (event,) = drive.tracker.open()
    assert event.end_s is None
    assert event.start_s == at(50)


def test_a_hole_in_the_log_is_one_miss_of_no_sensor() -> None:
    drive = Drive().run(BEFORE_HOLE)
    drive.run(1, gap_s=5.0).run(20)
    event = drive.only()
    assert (event.sensor, event.channel, event.kind) == (None, None, "missing")
    last = BEFORE_HOLE - 1
    assert (event.start_s, event.end_s) == (at(last), pytest.approx(START_S + last * TICK_S + 5.0))
    assert event.peak_score == pytest.approx(5.0)


@pytest.mark.parametrize("gap_s", [0.05, 0.3, GAP_S])
def test_a_short_hole_is_jitter(gap_s: float) -> None:
    assert Drive().run(BEFORE_HOLE).run(1, gap_s=gap_s - 1e-3).run(20).ended == []


def test_a_sensor_silent_before_and_after_a_hole_is_still_missing() -> None:
    drive = Drive().run(50).run(10, absent=(X, Y)).run(1, absent=(X, Y), gap_s=5.0).run(10, absent=(X, Y))
    (open_,) = drive.tracker.open()
    assert (open_.sensor, open_.kind, open_.start_s) == ("gyro", "missing", at(50))


@pytest.mark.parametrize("late", [1, 10, 14])
def test_a_first_fix_that_comes_late_is_no_miss(late: int) -> None:
    """A log is cut where it is cut: until a fix is overdue since the first tick, nothing is missing."""
    drive = Drive().run(late, absent=(EAST, NORTH))
    drive.count += -late % 5
    drive.run(30)
    assert drive.ended == drive.tracker.open() == []


def test_a_sensor_that_never_speaks_is_missing() -> None:
    drive = Drive().run(100, absent=(EAST, NORTH))
    (event,) = drive.tracker.open()
    assert (event.sensor, event.channel, event.kind) == ("gnss", None, "missing")
    assert START_S <= event.start_s <= START_S + 0.1 + 1e-6


def test_a_fault_and_a_silence_at_once() -> None:
    drive = Drive().run(50)
    drive.run(50, accused={X: 4.0}, absent=(EAST, NORTH))
    assert {(event.sensor, event.channel, event.kind) for event in drive.tracker.open()} == {
        ("gyro", "x", "offset"),
        ("gnss", None, "missing"),
    }
    starts = [event.start_s for event in drive.tracker.open()]
    assert starts == sorted(starts)


def test_asking_what_is_open_changes_nothing() -> None:
    asked, silent = Drive(), Drive()
    for drive in (asked, silent):
        for i in range(200):
            drive.run(1, accused={X: 0.1 * i} if i % 3 else {}, absent=(Y,) if i > 100 else ())
            if drive is asked:
                drive.tracker.open()
        drive.quiet()
    assert asked.ended == silent.ended
