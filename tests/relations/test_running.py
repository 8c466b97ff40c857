"""A log that goes on is judged as it would be as a whole."""

from dataclasses import replace

import numpy as np
import pytest

from relations.vehicles import CAR, COPTER, WING, Vehicle
from sensorfault.logs.table import Log
from sensorfault.relations.events import events_of
from sensorfault.relations.judge import judge
from sensorfault.relations.running import Running

BEGIN_S, END_S = 80.0, 126.0


def between(log: Log, start_s: float, end_s: float) -> Log:
    rows = (log.time >= start_s - 1e-6) & (log.time < end_s - 1e-6)
    return replace(log, time=log.time[rows], value=log.value[rows], fresh=log.fresh[rows])


def lied(vehicle: Vehicle) -> Log:
    """One sensor is silent, then one lies for some seconds, then another one for good."""
    *_, (first, little), (second, much) = vehicle.lies.items()
    log = vehicle.log
    value = log.value.copy()
    value[(log.time > 97.0) & (log.time < 100.0), log.index(first)] += little
    value[log.time > 113.0, log.index(second)] += much
    silent = (log.time > 82.0) & (log.time < 91.0)
    value[np.ix_(silent, list(log.of("accelerometer")))] = np.nan
    return replace(log, value=value, fresh=log.fresh & np.isfinite(value))


@pytest.mark.parametrize("vehicle", [CAR, COPTER, WING], ids=str)
def test_what_goes_on_is_judged_as_the_whole(vehicle: Vehicle) -> None:
    log, learned = lied(vehicle), vehicle.model.learned
    assert learned is not None
    running = Running(learned)
    running.whole(between(log, 0.0, BEGIN_S))
    for end_s in np.arange(BEGIN_S + 1, END_S):
        now = running.more(between(log, end_s - 1, end_s))
        assert now is not None
        if end_s % 5:
            continue
        whole = judge(between(log, 0.0, end_s), learned)
        (mine,), (theirs,) = now.pieces, whole.pieces
        assert [test.key for test in mine.tests] == [test.key for test in theirs.tests]
        limit = np.array([learned.limit.get(test.key, np.inf) for test in mine.tests])
        np.testing.assert_array_equal(np.isfinite(mine.moved), np.isfinite(theirs.moved))
        np.testing.assert_allclose(mine.moved / limit, theirs.moved / limit, atol=0.01)
        np.testing.assert_allclose(now.scores[0], whole.scores[0], atol=0.01, rtol=0.01)
        last_s = float(between(log, 0.0, end_s).time[-1])
        assert named(now, last_s) == named(whole, last_s)


def named(judged, last_s: float) -> set[tuple[str | None, str]]:
    """Who is accused, and of what."""
    return {(event.sensor, event.kind) for event in events_of(judged, last_s)}


def test_after_a_pause_the_whole_is_asked_for() -> None:
    running = Running(COPTER.model.learned)
    running.whole(between(COPTER.log, 0.0, BEGIN_S))
    assert running.more(between(COPTER.log, BEGIN_S + 5, BEGIN_S + 6)) is None
    assert running.more(between(COPTER.log, BEGIN_S + 6, BEGIN_S + 7)) is None


def test_a_minute_later_the_whole_is_asked_for() -> None:
    running = Running(COPTER.model.learned)
    running.whole(between(COPTER.log, 0.0, BEGIN_S))
    for end_s in np.arange(BEGIN_S + 5, 140.0, 5.0):
        assert running.more(between(COPTER.log, end_s - 5, end_s)) is not None
    assert running.more(between(COPTER.log, 140.0, 145.0)) is None


def test_what_is_too_short_or_too_slow_does_not_go_on() -> None:
    running = Running(COPTER.model.learned)
    running.whole(between(COPTER.log, 0.0, 70.0))
    assert running.more(between(COPTER.log, 70.0, 71.0)) is None
    slow = COPTER.log
    fresh = slow.fresh.copy()
    fresh[np.ix_(np.arange(len(slow)) % 100 != 0, list(slow.of("gnss")))] = False
    slow = replace(slow, value=np.where(fresh, slow.value, np.nan), fresh=fresh)
    running.whole(between(slow, 0.0, BEGIN_S))
    assert running.more(between(slow, BEGIN_S, BEGIN_S + 1)) is None
