"""What an estimator may take in of an accused sample."""

import jax.numpy as jnp
import numpy as np

from core.scripted import branch, each, says, script, walk
from sensorfault.core.types import FAULT
from sensorfault.stages.recovery.readmit import Readmit
from sensorfault.stages.recovery.rebuild import Rebuild

NAN = np.nan


def test_drop_takes_nothing_of_the_accused_and_puts_nothing_in_its_place() -> None:
    told = walk(says([branch(each(2))], (0, 1)), script([[0, 0], [2, 0], [0, 0]], [[1, 1], [5, 2], [3, 3]]))
    trust = told.reports.trust
    np.testing.assert_array_equal(trust.measured, [[True, True], [False, True], [True, True]])
    np.testing.assert_array_equal(trust.learn, [[True, True], [False, False], [True, True]])
    assert not trust.filled.any()
    np.testing.assert_array_equal(told.states.residual, [[1, 1], [1, 2], [3, 3]])


def rebuilding(channels: int, horizon_s: float, gates: bool = True, readmit_s: float = 0.0):
    recovery = Rebuild(jnp.asarray(horizon_s, float), jnp.asarray(readmit_s, float), channels)
    return says([branch(each(channels), gates=gates)], tuple(range(channels)), recovery=recovery)


def test_rebuild_puts_the_expected_value_in_its_place() -> None:
    rows = script([[0, 0], [2, 0], [0, 0]], [[1, 1], [5, 2], [3, 3]], expected=1.5)
    told = walk(rebuilding(2, 10.0), rows)
    trust = told.reports.trust
    np.testing.assert_array_equal(trust.value, [[1, 1], [1.5, 2], [3, 3]])
    np.testing.assert_array_equal(trust.filled, [[False, False], [True, False], [False, False]])
    assert not (trust.filled & trust.measured).any()
    assert not trust.learn[1].any()
    np.testing.assert_array_equal(told.states.residual[1], [1.5, 2])


def test_rebuild_believes_the_expected_value_only_for_so_long() -> None:
    told = walk(rebuilding(1, 2.0), script([[0], [2], [2], [2], [0], [2]], expected=7.0))
    np.testing.assert_array_equal(told.reports.trust.filled[:, 0], [False, True, True, False, False, True])
    np.testing.assert_array_equal(told.reports.trust.value[:, 0], [1, 7, 7, 1, 1, 7])


def test_rebuild_waits_before_it_readmits() -> None:
    """A score that dips below its limit does not make a fault healthy; nor is what is not believed learned from."""
    told = walk(rebuilding(1, 10.0, readmit_s=2.0), script([[0], [2], [0], [2], [0], [0], [0], [0]], expected=7.0))
    trust = told.reports.trust
    np.testing.assert_array_equal(trust.filled[:, 0], [False, True, True, True, True, True, False, False])
    np.testing.assert_array_equal(trust.measured[:, 0], ~trust.filled[:, 0])
    assert not (trust.learn & trust.filled).any()
    assert (told.channel[:, 0] == FAULT).sum() == 2


def test_rebuild_of_a_channel_that_was_never_healthy() -> None:
    told = walk(rebuilding(1, 1e6), script([[2], [2]], expected=7.0))
    assert (told.channel == FAULT).all()
    assert not told.reports.trust.filled.any()


def test_rebuild_leaves_alone_what_only_a_window_accuses() -> None:
    told = walk(rebuilding(1, 10.0, gates=False), script([[0], [2]], [[1], [5]], expected=7.0))
    assert told.channel[1, 0] == FAULT
    assert told.reports.trust.measured.all()
    np.testing.assert_array_equal(told.reports.trust.value[:, 0], [1, 5])
    np.testing.assert_array_equal(told.reports.trust.learn[:, 0], [True, False])


def readmitting(channels: int, readmit_s: float, gap_s: float = 1.5):
    recovery = Readmit(jnp.asarray(readmit_s), jnp.asarray(gap_s), channels)
    return says([branch(each(channels))], tuple(range(channels)), recovery=recovery)


def test_readmit_takes_in_again_what_has_passed_its_tests_for_long_enough() -> None:
    """Without a break: an accusation begins the time anew, and so does a silence; neither concerns another channel."""
    accused = [[0, 0], [2, 0], [0, 0], [2, 0], [0, 0], [0, 0], [0, 0], [0, 0]]
    value = np.arange(16.0).reshape(8, 2)
    told = walk(readmitting(2, 2.0), script(accused, value))
    trust = told.reports.trust
    np.testing.assert_array_equal(trust.measured[:, 0], [True, False, False, False, False, False, True, True])
    assert trust.measured[:, 1].all()
    assert not trust.filled.any()
    assert not (trust.learn[:, 0] & ~trust.measured[:, 0]).any()
    np.testing.assert_array_equal(told.states.residual[:, 0], [0, 0, 0, 0, 0, 0, 12, 14])


def test_readmit_counts_only_tests_passed() -> None:
    """Hidden for four seconds, it is as suspect as before, and begins its time anew."""
    value = np.ones((10, 1))
    value[3:7] = NAN
    told = walk(readmitting(1, 2.0), script([[0], [2], [0], [0], [0], [0], [0], [0], [0], [0]], value))
    np.testing.assert_array_equal(told.reports.trust.measured[:, 0], [True, *[False] * 8, True])


def test_readmit_does_not_try_another_source() -> None:
    rows = script([[0], [2], [0], [0]], np.ones((4, 1)))
    rows = rows._replace(born=np.array([[False], [False], [True], [False]]))
    told = walk(readmitting(1, 100.0), rows)
    np.testing.assert_array_equal(told.reports.trust.measured[:, 0], [True, False, True, True])


def test_readmit_at_once_is_drop() -> None:
    rows = script([[0], [2], [0], [2]], np.arange(4.0)[:, None])
    told = [walk(monitor, rows).reports.trust for monitor in (readmitting(1, 0.0), says([branch(each(1))], (0,)))]
    np.testing.assert_array_equal(told[0].measured, told[1].measured)
