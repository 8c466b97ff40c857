"""Exceed at once, persist for a while, and whom an alarm accuses."""

import jax.numpy as jnp
import numpy as np
import pytest

from core.scripted import Says, branch, each, says, script, walk
from sensorfault.core.types import FAULT, OK, UNKNOWN
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.decision.persist import Persist

NAN = np.nan


def three_of_five(channels: int, hold_s: float = 0.0):
    return says([branch(each(channels))], tuple(range(channels)), decision=Persist(channels, 3, 5), hold_s=hold_s)


def test_persist_needs_its_number_within_its_window() -> None:
    over = np.array([2, 0, 2, 0, 2, 0, 2, 0, 0, 2.0])[:, None]
    told = walk(three_of_five(1), script(over))
    #                1 1 2 2 3 2 3 2 2 2: exceedances among the last five
    expected = [OK, OK, OK, OK, FAULT, OK, FAULT, OK, OK, OK]
    np.testing.assert_array_equal(told.channel[:, 0], expected)


def test_persist_counts_tests_and_not_samples() -> None:
    """A 10 Hz fix has as many tests as fixes: the samples between neither count nor forget."""
    fresh = (np.arange(9) % 2 == 0)[:, None]
    told = walk(three_of_five(1), script(np.full((9, 1), 2.0), fresh=fresh))
    assert told.channel[4, 0] == FAULT
    assert told.channel[2, 0] == OK
    np.testing.assert_array_equal(told.channel[1::2, 0], [UNKNOWN] * 4)


def test_a_persistent_verdict_is_held_like_any_other() -> None:
    fresh = np.array([1, 1, 1, 0, 0, 0], bool)[:, None]
    told = walk(three_of_five(1, hold_s=2.0), script(np.full((6, 1), 2.0), fresh=fresh))
    np.testing.assert_array_equal(told.channel[:, 0], [OK, OK, FAULT, FAULT, FAULT, UNKNOWN])


def test_persist_counts_who_was_struck_in_this_sample() -> None:
    """Exclusion judges one sample several times; each channel is still counted once."""
    monitor = says([branch(each(2))], (0, 1), most=2, decision=Persist(2, 2, 3))
    told = walk(monitor, script([[2, 0], [2, 3], [0, 3], [0, 0]]))
    np.testing.assert_array_equal(told.channel, [[OK, OK], [FAULT, OK], [FAULT, FAULT], [OK, FAULT]])


@pytest.mark.parametrize(("needed", "window"), [(0, 5), (6, 5), (1, 32)])
def test_persist_says_what_it_needs(needed: int, window: int) -> None:
    with pytest.raises(ValueError, match="1 <= needed <= window <= 31"):
        Persist(1, needed, window)


def test_share_decides_how_many_an_alarm_accuses() -> None:
    shares = Says(jnp.ones((1, 3), bool), jnp.array([[0.6, 0.3, 0.1]]))
    for share, named in ((1.0, 1), (0.5, 2), (0.1, 3)):
        monitor = says([branch(shares)], (0, 1, 2), decision=Exceed(share))
        told = walk(monitor, script([[2.0]], np.ones((1, 3))))
        assert (told.channel[0] == FAULT).sum() == named


def test_a_negative_or_no_limit_accuses_whatever_the_score() -> None:
    for limit in (0.0, -1.0, -np.inf):
        told = walk(says([branch(each(2), limit)], (0, 1), most=1), script([[0.5, -0.5]]))
        assert told.channel[0, 0] == FAULT
        assert np.isfinite(told.states.residual).all()
