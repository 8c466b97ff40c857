"""Mistakes made once: each of these failed before it was mended."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from core.scripted import FromBlock, Says, branch, each, says, script, walk
from laws.cases.guests import ZOO
from laws.compilations import compilations
from laws.walk import walk as plain_walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.runtime.runners import Stepper
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.stages.threshold.fixed import Fixed


@pytest.mark.parametrize("case", ZOO.values(), ids=str)
def test_a_continued_replay_is_not_compiled_again(case):
    """Once: jnp.full(n, NEVER) is weakly typed: the state after a log has another type than the one before it."""
    end = jax.tree.map(lambda x: x[-1], plain_walk(case.monitor, case.rows).states)
    with compilations() as made:
        plain_walk(case.monitor, case.rows, end)
    assert not made


def test_a_window_alarm_gates_nothing_when_sensors_may_be_excluded():
    """Once: with most > 0 gates=False was forgotten: the exclusion loop struck on window alarms, and struck gates."""
    window = branch(each(2, 1), gates=False)
    result = walk(says([branch(each(2)), window], (0, 1), most=2), script(([[0, 0], [0, 2]], [[2, 0], [0, 0]])))
    np.testing.assert_array_equal(result.channel, [[FAULT, OK], [OK, FAULT]])
    np.testing.assert_array_equal(result.reports.trust.measured, [[True, True], [True, False]])


def test_unknown_because_the_rounds_ran_out_stays_unknown_while_held():
    """Once: the decision remembers `named`, so what was UNKNOWN becomes FAULT on the next held row."""
    fresh = np.array([[True, True], [False, False]])
    result = walk(says([branch(each(2))], (0, 1), most=1, hold_s=2.0), script([[5, 3], [0, 0]], fresh=fresh))
    np.testing.assert_array_equal(result.channel, [[FAULT, UNKNOWN], [FAULT, UNKNOWN]])


class Counting(Says):
    def init(self):
        return jnp.zeros(())

    def evaluate(self, state, residual):
        return super().evaluate((), residual)[0], state + 1

    def update(self, pending, trust):
        return pending


class Poisoned(Counting):
    def update(self, pending, trust):
        return jnp.where(pending > 2, jnp.nan, pending)


def test_one_poisoned_branch_does_not_freeze_its_neighbour():
    """Once: keep_finite is applied to all branches as one."""
    eye = jnp.eye(1, dtype=bool), jnp.eye(1)
    result = walk(says([branch(Poisoned(*eye)), branch(Counting(*eye))], (0,)), script(([[0]] * 5, [[0]] * 5)))
    np.testing.assert_array_equal(result.states.branches[1][0], [1, 2, 3, 4, 5])


def test_a_huge_value_is_named():
    """Once: the square overflows, blame is inf / inf = NaN: nobody is accused and the filter takes the value in."""
    monitor = says([Branch(Norm(jnp.ones(2)), Fixed(jnp.ones(1)))], (0, 1))
    result = walk(monitor, script(np.zeros((1, 1)), [[1e200, 0.1]]))
    np.testing.assert_array_equal(result.channel, [[FAULT, OK]])
    assert not result.reports.trust.measured[0, 0]


def test_a_clock_that_goes_back_holds_nothing():
    """Once: time - seen < 0 <= hold_s: an absent channel keeps its verdict until the clock has caught up."""
    value = [[1.0], [np.nan], [np.nan], [np.nan]]
    result = walk(says([branch(each(1))], (0,)), script([[0]] * 4, value, time=[1000.0, 0.0, 1.0, 500.0]))
    np.testing.assert_array_equal(result.channel[1:, 0], [UNKNOWN] * 3)


def test_a_rebuilt_value_stands_while_the_faulty_one_is_held():
    """Once: on held rows of a faulty channel the stand-in gives way to the lie."""
    fresh = np.array([True, True, False, False])[:, None]
    monitor = says(
        [branch(each(1))], (0,), hold_s=5.0, recovery=Rebuild(jnp.asarray(10.0, float), jnp.asarray(0.0, float), 1)
    )
    result = walk(monitor, script([[0], [2], [0], [0]], [[1], [50], [50], [50]], fresh=fresh, expected=7.0))
    np.testing.assert_array_equal(result.channel[:, 0], [OK, FAULT, FAULT, FAULT])
    np.testing.assert_array_equal(result.reports.trust.value[:, 0], [1, 7, 7, 7])


def test_a_new_source_without_a_value_forgets_the_last_one():
    """Once: Repeats forgets at a birth only if that very sample is valid."""
    monitor = says([Branch(Repeats(1), Fixed(jnp.zeros(1)))], (0,))
    rows = script([[0]] * 3, [[3], [np.nan], [3]])._replace(born=np.array([[False], [True], [False]]))
    result = walk(monitor, rows)
    assert result.reports.scores[0].value[2, 0] == 0


def test_a_first_value_of_zero_repeats_nothing():
    """Once: the memory of Repeats starts with a measurement of zero."""
    result = walk(says([Branch(Repeats(1), Fixed(jnp.zeros(1)))], (0,)), script([[0]], [[0.0]]))
    assert result.reports.scores[0].value[0, 0] == 0


class TakesFlags(FromBlock):
    def evaluate(self, state, sample):
        block = type("B", (), {"expected": jnp.zeros(1), "scores": (sample.block.astype(float)[:1],)})
        return super().evaluate(state, sample._replace(block=block))


@pytest.mark.parametrize("block", [np.array([True, False]), np.array([1, 2], np.int32)])
def test_a_block_of_one_type_that_is_not_float(block):
    """Once: ravel_pytree of a block that is all bool (or int32) refuses to restore it from float64."""
    monitor = says([branch(each(1))], (0,))
    monitor = Monitor(TakesFlags(1), monitor.branches, monitor.decision, monitor.recovery, monitor.hold_s, (0,))
    with jax.numpy_dtype_promotion("standard"):
        assert Stepper(monitor, block).push(0.0, [1.0], True, block).sample in (OK, FAULT)


def test_a_forgotten_block_is_not_the_last_one():
    """Once: push without a block silently takes the one before (at first: ones)."""
    case = ZOO["block"]
    with jax.numpy_dtype_promotion("standard"):
        stepper = Stepper(case.monitor, jax.tree.map(lambda x: x[0], case.rows.block))
        with pytest.raises((TypeError, ValueError)):
            stepper.push(0.0, [1.0, 1.0])


def test_an_empty_block_is_no_block():
    """Once: push(block=()) raised 'need at least one array', though () is what 'no block' is elsewhere."""
    with jax.numpy_dtype_promotion("standard"):
        stepper = Stepper(ZOO["kalman"].monitor)
        said, same = (stepper.push(t, [1.0, 1.0, 1.0], True, *block) for t, block in ((0.0, ()), (0.1, ((),))))
        assert len(said.channel) == len(same.channel) == 3


def test_too_few_values_are_refused():
    """Once: one number is broadcast over all channels."""
    with jax.numpy_dtype_promotion("standard"):
        stepper = Stepper(ZOO["kalman"].monitor)
        for value in (1.0, [1.0]):
            with pytest.raises(ValueError):
                stepper.push(0.0, value)
