"""What a verdict means: silence is not health, a sensor is its worst channel, and some alarms cannot name anyone."""

import jax.numpy as jnp
import numpy as np

from core.scripted import Says, branch, each, says, script, walk
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN

NAN = np.nan


def test_each_channel_is_judged_and_a_sensor_is_its_worst_channel() -> None:
    result = walk(says([branch(each(3))], owner=(1, 0, 1)), script([[0, 0, 2], [0, 2, 0], [0, 0, 0]]))
    np.testing.assert_array_equal(result.channel, [[OK, OK, FAULT], [OK, FAULT, OK], [OK, OK, OK]])
    np.testing.assert_array_equal(result.sensor, [[OK, FAULT], [FAULT, OK], [OK, OK]])
    np.testing.assert_array_equal(result.sample, [FAULT, FAULT, OK])


def test_a_limit_itself_is_not_exceeded() -> None:
    assert walk(says([branch(each(1))], (0,)), script([[1.0]])).sample[0] == OK


def test_silence_is_not_health() -> None:
    """A channel that no test covers is unknown, and so is its sensor; the sample is judged by what was tested."""
    first_only = Says(jnp.array([[True, False]]), jnp.array([[1.0, 0.0]]))
    result = walk(says([branch(first_only)], (0, 1)), script([[0.0], [2.0]], np.ones((2, 2))))
    np.testing.assert_array_equal(result.channel, [[OK, UNKNOWN], [FAULT, UNKNOWN]])
    np.testing.assert_array_equal(result.sensor, [[OK, UNKNOWN], [FAULT, UNKNOWN]])
    np.testing.assert_array_equal(result.sample, [OK, FAULT])


def test_unknown_is_worse_than_ok_within_a_sensor() -> None:
    result = walk(says([branch(each(2))], (0, 0)), script([[0, 0]], [[1, NAN]]))
    np.testing.assert_array_equal(result.channel, [[OK, UNKNOWN]])
    np.testing.assert_array_equal(result.sensor, [[UNKNOWN]])


def test_an_alarm_without_blame_is_unknown_which() -> None:
    """Something is wrong, nobody is named: nothing learns from the sample, nobody is kept out of the filter."""
    blameless = Says(jnp.ones((1, 2), bool), jnp.zeros((1, 2)))
    result = walk(says([branch(blameless)], (0, 1)), script([[2.0], [0.0]], np.ones((2, 2))))
    np.testing.assert_array_equal(result.sample, [FAULT, OK])
    assert not (result.sensor == FAULT).any()
    np.testing.assert_array_equal(result.reports.trust.learn, [[False, False], [True, True]])
    assert result.reports.trust.measured.all()


def test_blame_is_shared_by_those_with_half_of_the_largest() -> None:
    shares = Says(jnp.ones((1, 4), bool), jnp.array([[0.5, 0.25, 0.2, 0.05]]))
    result = walk(says([branch(shares)], (0, 1, 2, 3)), script([[2.0]], np.ones((1, 4))))
    np.testing.assert_array_equal(result.channel, [[FAULT, FAULT, OK, OK]])


def test_an_alarm_that_does_not_gate_names_and_keeps_nothing_out() -> None:
    window = branch(each(2, 1), gates=False)
    result = walk(says([branch(each(2)), window], (0, 1)), script(([[0, 0], [0, 2]], [[2, 0], [0, 0]])))
    np.testing.assert_array_equal(result.channel, [[FAULT, OK], [OK, FAULT]])
    np.testing.assert_array_equal(result.reports.trust.measured, [[True, True], [True, False]])
    assert not result.reports.trust.learn.any()


def test_a_score_or_limit_that_is_no_number_is_no_test() -> None:
    result = walk(says([branch(each(2))], (0, 1)), script([[NAN, 0]]))
    np.testing.assert_array_equal(result.channel, [[UNKNOWN, OK]])
    result = walk(says([branch(each(2), limit=NAN)], (0, 1)), script([[2, 0]]))
    np.testing.assert_array_equal(result.channel, [[UNKNOWN, UNKNOWN]])
    np.testing.assert_array_equal(result.sample, [UNKNOWN])


def test_a_second_branch_covers_what_the_first_cannot() -> None:
    first_only = Says(jnp.array([[True, False]]), jnp.array([[1.0, 0.0]]), 0)
    second_only = Says(jnp.array([[False, True]]), jnp.array([[0.0, 1.0]]), 1)
    result = walk(says([branch(first_only), branch(second_only)], (0, 1)), script(([[0.0]], [[2.0]]), np.ones((1, 2))))
    np.testing.assert_array_equal(result.channel, [[OK, FAULT]])
