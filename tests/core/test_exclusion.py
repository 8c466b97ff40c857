"""The loop inside one sample: take out the worst sensor, judge the rest again."""

import jax.numpy as jnp
import numpy as np

from core.scripted import FromBlock, branch, each, says, script, walk
from laws.guests.statistics import Outlier
from laws.guests.zoo import two_fixes
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.threshold.fixed import Fixed


class OneUnknown(FromBlock):
    """All channels measure one unknown of which little is known before: a lie shows in everyone's test."""

    def evaluate(self, state, sample):
        residual, pending = super().evaluate(state, sample)
        return residual._replace(cov=100.0 * jnp.ones((self.channels,) * 2) + jnp.eye(self.channels)), pending


def one_unknown(most: int, channels: int = 4) -> Monitor:
    hold_s = jnp.zeros(channels)
    branches = (Branch(Outlier(), Fixed(jnp.full(channels, 4.0))),)
    return Monitor(OneUnknown(channels), branches, Exceed(), Drop(), hold_s, tuple(range(channels)), most)


def lies(*value: float):
    return script(np.zeros((1, len(value))), [value])


def test_one_pass_blames_innocents_and_the_loop_none() -> None:
    rows = lies(0.3, -0.5, 25.0, 0.1)
    at_once = walk(one_unknown(most=0), rows)
    np.testing.assert_array_equal(at_once.channel, [[FAULT, FAULT, FAULT, FAULT]])
    one_by_one = walk(one_unknown(most=2), rows)
    np.testing.assert_array_equal(one_by_one.channel, [[OK, OK, FAULT, OK]])
    np.testing.assert_array_equal(one_by_one.reports.trust.measured, [[True, True, False, True]])


def test_two_liars_take_two_rounds() -> None:
    rows = lies(0.3, -0.5, 15.0, 0.1, -9.0)
    result = walk(one_unknown(most=2, channels=5), rows)
    np.testing.assert_array_equal(result.channel, [[OK, OK, FAULT, OK, FAULT]])


def test_who_is_still_accused_when_the_rounds_run_out_is_unknown_and_kept_out() -> None:
    rows = lies(0.3, -0.5, 15.0, 0.1, -9.0)
    result = walk(one_unknown(most=1, channels=5), rows)
    assert result.channel[0, 2] == FAULT
    assert result.channel[0, 4] == UNKNOWN
    assert result.sensor[0, 4] == UNKNOWN
    assert result.sample[0] == FAULT
    assert not result.reports.trust.measured[0, [2, 4]].any()
    assert not result.reports.trust.learn.any()


def test_the_largest_goes_first() -> None:
    result = walk(says([branch(each(3))], (0, 1, 2), most=1), script([[2, 5, 3], [5, 2, 0]]))
    np.testing.assert_array_equal(result.channel, [[UNKNOWN, FAULT, UNKNOWN], [FAULT, UNKNOWN, OK]])


def test_a_sensor_goes_with_all_its_channels() -> None:
    """The channels that were not accused are not faulty: they are unknown, and out of the filter with the rest."""
    result = walk(says([branch(each(4))], (0, 1, 0, 1), most=1), script([[0, 0, 5, 0]]))
    np.testing.assert_array_equal(result.channel, [[UNKNOWN, OK, FAULT, OK]])
    np.testing.assert_array_equal(result.sensor, [[FAULT, OK]])
    np.testing.assert_array_equal(result.reports.trust.measured, [[False, True, False, True]])


def test_reported_scores_are_those_of_the_first_judgement() -> None:
    rows = lies(0.3, -0.5, 15.0, 0.1)
    loop, at_once = (walk(one_unknown(most), rows).reports.scores[0] for most in (2, 0))
    np.testing.assert_array_equal(loop.value, at_once.value)
    assert loop.valid.all()


def test_two_receivers_whose_channels_are_interleaved() -> None:
    """A receiver that lies on one axis is out on both; the other receiver and the speedometer are cleared."""
    monitor = two_fixes()
    value = np.tile([10.0, 10.0, 10.0, 10.0, 0.0], (12, 1))
    value[-1, 0] += 5.0
    result = walk(monitor, script(np.zeros((12, 5)), value, time=0.02 * np.arange(12)))
    np.testing.assert_array_equal(result.channel[-2], [OK] * 5)
    np.testing.assert_array_equal(result.channel[-1], [FAULT, OK, UNKNOWN, OK, OK])
    np.testing.assert_array_equal(result.sensor[-1], [OK, FAULT, OK])
