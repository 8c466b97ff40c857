"""What each guest is there to show, beyond the laws."""

import functools

import numpy as np

from laws.case import Case
from laws.damage import half, lied
from laws.guests import zoo
from laws.walk import walk
from sensorfault.core.verdicts import FAULT, OK


@functools.cache
def windowed() -> Case:
    return zoo.windowed()


def test_a_window_takes_what_the_filter_may_not() -> None:
    """Evidence is not reference: a gated value counts in the window and is unknown to the filter."""
    case = windowed()
    k = half(case.rows)
    result = walk(case.monitor, lied(case.rows, slice(k, k + 1), [20.0, 0.0, 0.0]))
    assert not result.reports.trust.measured[k, 0]
    window = result.states.branches[1][0]
    np.testing.assert_array_equal(window.count[k] - window.count[k - 1], [1, 1, 1])
    assert abs(window.total[k, 0] - window.total[k - 1, 0]) > 20.0


def test_a_lie_that_only_the_window_sees_is_named_and_taken_in() -> None:
    case = windowed()
    k = half(case.rows)
    result = walk(case.monitor, lied(case.rows, slice(k, k + 100), [0.0, 0.0, 3.0]))
    instant, window = result.reports.scores
    assert (instant.value[k : k + 100, 2] < result.reports.limits[0][k : k + 100, 2]).all()
    assert (window.value[k + 25 : k + 100, 2] > result.reports.limits[1][k + 25 : k + 100, 2]).mean() > 0.9
    named = result.channel[:, 2] == FAULT
    assert named[k + 25 : k + 100].mean() > 0.9
    assert result.reports.trust.measured[named].all()
    assert not result.reports.trust.learn[named].any()
    assert (result.channel[k + 130 :] == OK).all()


def test_the_learner_gets_better_and_only_from_what_it_trusts() -> None:
    case = zoo.learner()
    result = walk(case.monitor, case.rows)
    error = np.abs(result.reports.residual.value[200:]).mean(axis=0)
    persistence = np.abs(np.diff(case.rows.value, axis=0)[199:]).mean(axis=0)
    assert (error < 0.5 * persistence).all()
    misled = walk(case.monitor, lied(case.rows, slice(200, 220), [5.0, 0.0]))
    assert not misled.reports.trust.learn[200:220, 0].any()
    weights = misled.states.residual.weights
    np.testing.assert_array_equal(weights[199:220, 0], np.broadcast_to(weights[199, 0], (21, 3)))


def test_the_bank_accuses_whom_all_but_one_member_accuse() -> None:
    case = zoo.bank()
    k = half(case.rows)
    for c in range(4):
        result = walk(case.monitor, lied(case.rows, slice(k, k + 1), np.where(np.arange(4) == c, 20.0, 0.0)))
        over = result.reports.scores[0].value[k] > result.reports.limits[0][k]
        np.testing.assert_array_equal(over, np.arange(4) != c)
        np.testing.assert_array_equal(result.channel[k] == FAULT, np.arange(4) == c)
