"""Live never raises on a number, and its clock neither runs backwards nor dies."""

import math
import pickle

import numpy as np
import pytest

import fitted
from sensorfault.core.verdicts import FAULT, OK
from sensorfault.events.classifier import FaultClassifier
from sensorfault.runtime.detect import Live
from sensorfault.runtime.live_clock import FOLLOWED_AFTER_S, LiveClock


@pytest.mark.parametrize("time", [math.nan, math.inf, -math.inf, 1e308, 1.7e18])
def test_a_time_that_is_none_changes_nothing(time: float) -> None:
    clock = LiveClock()
    for taken in (1.0, 2.0):
        with pytest.raises(ValueError, match="give the time of the sample"):
            clock.take(time)
        assert clock.take(taken) == taken


def test_a_clock_that_was_set_back_is_followed() -> None:
    clock = LiveClock()
    assert clock.take(100.0) == 100.0
    refused = 0
    for i in range(100):
        try:
            rising = clock.take(5.0 + 0.1 * i)
        except ValueError:
            refused += 1
            continue
        assert rising > 100.0
        break
    assert refused == pytest.approx(FOLLOWED_AFTER_S / 0.1, abs=2)
    assert clock.take(8.0) > rising


def test_a_clock_that_was_set_far_ahead_is_followed_after_a_while() -> None:
    clock = LiveClock()
    clock.take(10.0)
    refused = 0
    for i in range(100):
        try:
            assert clock.take(1e9 + 0.1 * i) == 1e9 + 0.1 * i
        except ValueError:
            refused += 1
            continue
        break
    assert refused == pytest.approx(FOLLOWED_AFTER_S / 0.1, abs=2)


def test_one_reading_far_ahead_costs_one_sample() -> None:
    clock = LiveClock()
    clock.take(10.0)
    for wild in (1e9, 5e9):
        with pytest.raises(ValueError, match="in order"):
            clock.take(wild)
    assert clock.take(10.1) == 10.1


def test_one_late_sample_is_dropped() -> None:
    clock = LiveClock()
    clock.take(10.0)
    with pytest.raises(ValueError, match="in order"):
        clock.take(9.9)
    assert clock.take(10.1) == 10.1


def live() -> Live:
    return Live(fitted.model("relative-conditioning"))


def push_all(live: Live, value: np.ndarray, begin: int = 0) -> list[int]:
    return [live.push(0.02 * (begin + i + 1), row).sample for i, row in enumerate(value)]


@pytest.mark.parametrize("size", [1e308, -1e308, 1e200, 5e307])
def test_an_absurd_number_is_a_fault(size: float) -> None:
    log = fitted.rig().select(fitted.model("relative-conditioning").inputs).between(end_s=4.0)
    value = log.value.copy()
    value[150:170, 0] = np.where(np.arange(20) % 2, size, -size)
    watching = live()
    said = push_all(watching, value)
    assert FAULT in said[150:155]
    assert said[149] == OK
    assert all(math.isfinite(event.start_s) for event in [*watching.events, *watching.open()])


def test_a_failed_push_changes_nothing() -> None:
    log = fitted.rig().select(fitted.model("relative-conditioning").inputs).between(end_s=2.0)
    one, other = live(), live()
    for i, row in enumerate(log.value):
        if i == 50:
            for wrong in ((math.nan, row), (0.5, row), (2.0, row[:-1]), (2.0, row, [True, False])):
                with pytest.raises(ValueError):
                    one.push(*wrong)
        a, b = one.push(log.time[i] + 1, row), other.push(log.time[i] + 1, row)
        np.testing.assert_array_equal(a.channel, b.channel)
        np.testing.assert_array_equal(a.score, b.score)


def test_a_pickled_one_goes_on_where_it_was() -> None:
    log = fitted.rig().select(fitted.model("relative-conditioning").inputs).between(end_s=3.0)
    whole, first = live(), live()
    expected = [whole.push(t + 1, row) for t, row in zip(log.time, log.value, strict=True)]
    for t, row in zip(log.time[:70], log.value[:70], strict=True):
        first.push(t + 1, row)
    second = pickle.loads(pickle.dumps(first))
    for want, t, row in zip(expected[70:], log.time[70:], log.value[70:], strict=True):
        got = second.push(t + 1, row)
        np.testing.assert_array_equal(got.score, want.score)
        np.testing.assert_array_equal(got.channel, want.channel)


def test_huge_residuals_have_a_kind() -> None:
    classifier = FaultClassifier()
    classifier.take([(0.1 * i, 1e308 * (-1) ** i, 1e308 * (-1) ** i) for i in range(50)])
    assert classifier.kind(0.1, 1.0) in ("noise", "unknown", "offset", "drift", "frozen")
    assert math.isfinite(classifier.size)
