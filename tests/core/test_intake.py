"""What is there, what is held, and what is not there."""

import numpy as np
import pytest

from core.scripted import branch, each, says, script, walk
from laws.damage import put
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN

NAN = np.nan


@pytest.mark.parametrize("nothing", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_not_there(nothing: float) -> None:
    rows = script(np.zeros((2, 2)), np.ones((2, 2)))
    rows = rows._replace(value=put(rows.value, (1, 0), nothing))  # and the log insists that it is
    result = walk(says([branch(each(2))], (0, 1)), rows)
    np.testing.assert_array_equal(result.channel, [[OK, OK], [UNKNOWN, OK]])
    np.testing.assert_array_equal(result.reports.trust.measured, [[True, True], [False, True]])
    np.testing.assert_array_equal(result.reports.trust.value[1], [1.0, 1.0])


def test_held_keeps_its_verdict_for_the_stated_time_and_no_longer() -> None:
    fresh = np.array([True, False, False, False])[:, None]
    for score, verdict in ((0, OK), (2, FAULT)):
        result = walk(says([branch(each(1))], (0,), hold_s=2.0), script([[score], [0], [0], [0]], fresh=fresh))
        np.testing.assert_array_equal(result.channel[:, 0], [verdict, verdict, verdict, UNKNOWN])
        np.testing.assert_array_equal(result.sample, [verdict, verdict, verdict, UNKNOWN])
        np.testing.assert_array_equal(result.reports.trust.measured[1:, 0], [False, False, False])


def test_a_held_score_does_not_count() -> None:
    """A test whose channel is not fresh is no test, whatever the statistic says."""
    result = walk(says([branch(each(1))], (0,), hold_s=5.0), script([[0], [9]], fresh=[[True], [False]]))
    np.testing.assert_array_equal(result.channel[:, 0], [OK, OK])


def test_missing_is_held_like_repeated() -> None:
    """Whether a log repeats the last fix or leaves it out, the verdicts are the same."""
    fresh = np.array([True, False, False, True, False, False, False, True])[:, None]
    scores = np.array([[0], [0], [0], [2], [0], [0], [0], [0]])
    value = np.array([1, 1, 1, 4, 4, 4, 4, 5.0])[:, None]
    monitor = says([branch(each(1))], (0,), hold_s=2.0)
    repeated = walk(monitor, script(scores, value, fresh=fresh))
    missing = walk(monitor, script(scores, np.where(fresh, value, NAN)))
    np.testing.assert_array_equal(repeated.channel, missing.channel)
    np.testing.assert_array_equal(repeated.reports.trust.value, missing.reports.trust.value)


def test_silence_is_counted_from_the_last_value() -> None:
    value = np.array([1, NAN, NAN, 1, 1])[:, None]
    result = walk(says([branch(each(1))], (0,)), script(np.zeros((5, 1)), value))
    np.testing.assert_array_equal(result.reports.silence[1:, 0], [1, 2, 3, 1])
    assert result.reports.silence[0, 0] > 1e9
