"""A fault that smears over its neighbours is laid at the right door, and the rest is judged without it."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from core.scripted import FromBlock, branch, each, says, script, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.fixed import Fixed


class Smearing(FromBlock):
    """Channel 0 lies by its value; twice as much of it shows in channel 1. Without channel 0 nothing is left."""

    def evaluate(self, state, sample):
        residual, pending = super().evaluate(state, sample)
        shows = jnp.array([1.0, 2.0, 0.1]) * residual.value[0] + jnp.array([0.0, 0.0, 1.0]) * residual.value[2]
        lone = jnp.zeros(3).at[2].set(residual.value[2])  # what is left without channel 0
        extra = jnp.stack([lone, shows * jnp.array([1.0, 0.9, 1.0]), shows])
        return residual._replace(value=shows, extra=extra), pending


def smearing(statistic, most: int = 1) -> Monitor:
    branches = (Branch(statistic(jnp.ones(3)), Fixed(jnp.ones(1))),)
    return Monitor(Smearing(3), branches, Exceed(1.0), Drop(), jnp.zeros(3), (0, 0, 1), most, together=False)


def test_the_culprit_is_named_and_the_others_are_cleared() -> None:
    rows = script(np.zeros((1, 1)), [[5.0, 0, 0]])
    np.testing.assert_array_equal(walk(smearing(Exchange), rows).channel, [[FAULT, OK, OK]])


def test_the_largest_share_would_have_named_an_innocent() -> None:
    rows = script(np.zeros((1, 1)), [[5.0, 0, 0]])
    assert walk(smearing(Norm), rows).channel[0, 1] == FAULT


def test_a_second_fault_is_left_over_and_not_cleared() -> None:
    rows = script(np.zeros((1, 1)), [[5.0, 0, 4.0]])
    result = walk(smearing(Exchange), rows)
    assert result.channel[0, 0] == FAULT
    assert result.channel[0, 2] != OK


def test_alone_or_together() -> None:
    """A lying axis leaves its sensor's others to be judged; a lying fix is out as a whole."""
    rows = script([[5, 0, 0]], np.ones((1, 3)))
    whole = says([branch(each(3))], (0, 0, 1), most=1)
    np.testing.assert_array_equal(walk(whole, rows).channel, [[FAULT, UNKNOWN, OK]])
    np.testing.assert_array_equal(walk(replace(whole, together=False), rows).channel, [[FAULT, OK, OK]])


def test_certain_accusations_go_first_and_all_at_once() -> None:
    """An exact repeat needs no comparison of sizes: it is struck before a joint test, however loud, is listened to."""
    joint = branch(each(3, 0))
    repeats = branch(each(3, 1))
    rows = script(([[0, 0, 9]], [[2, 2, 0]]), np.ones((1, 3)))
    unsure = says([joint, repeats], (0, 1, 2), most=1)
    np.testing.assert_array_equal(walk(unsure, rows).channel, [[UNKNOWN, UNKNOWN, FAULT]])
    sure = says([joint, replace(repeats, certain=True)], (0, 1, 2), most=1)
    np.testing.assert_array_equal(walk(sure, rows).channel, [[FAULT, FAULT, UNKNOWN]])
