"""What an estimator may take in of an accused sample."""

import jax.numpy as jnp
import numpy as np

from core.scripted import branch, each, says, script, walk
from sensorfault.core.verdicts import FAULT
from sensorfault.stages.recovery.rebuild import Rebuild

NAN = np.nan


def test_drop_takes_nothing_of_the_accused_and_puts_nothing_in_its_place() -> None:
    result = walk(says([branch(each(2))], (0, 1)), script([[0, 0], [2, 0], [0, 0]], [[1, 1], [5, 2], [3, 3]]))
    trust = result.reports.trust
    np.testing.assert_array_equal(trust.measured, [[True, True], [False, True], [True, True]])
    np.testing.assert_array_equal(trust.learn, [[True, True], [False, False], [True, True]])
    assert not trust.filled.any()
    np.testing.assert_array_equal(result.states.residual, [[1, 1], [1, 2], [3, 3]])


def rebuilding(channels: int, horizon_s: float, gates: bool = True, readmit_s: float = 0.0):
    recovery = Rebuild(jnp.asarray(horizon_s, float), jnp.asarray(readmit_s, float), channels)
    return says([branch(each(channels), gates=gates)], tuple(range(channels)), recovery=recovery)


def test_rebuild_puts_the_expected_value_in_its_place() -> None:
    rows = script([[0, 0], [2, 0], [0, 0]], [[1, 1], [5, 2], [3, 3]], expected=1.5)
    result = walk(rebuilding(2, 10.0), rows)
    trust = result.reports.trust
    np.testing.assert_array_equal(trust.value, [[1, 1], [1.5, 2], [3, 3]])
    np.testing.assert_array_equal(trust.filled, [[False, False], [True, False], [False, False]])
    assert not (trust.filled & trust.measured).any()
    assert not trust.learn[1].any()
    np.testing.assert_array_equal(result.states.residual[1], [1.5, 2])


def test_rebuild_believes_the_expected_value_only_for_so_long() -> None:
    result = walk(rebuilding(1, 2.0), script([[0], [2], [2], [2], [0], [2]], expected=7.0))
    np.testing.assert_array_equal(result.reports.trust.filled[:, 0], [False, True, True, False, False, True])
    np.testing.assert_array_equal(result.reports.trust.value[:, 0], [1, 7, 7, 1, 1, 7])


def test_rebuild_waits_before_it_readmits() -> None:
    """A score that dips below its limit does not make a fault healthy; nor is what is not believed learned from."""
    result = walk(rebuilding(1, 10.0, readmit_s=2.0), script([[0], [2], [0], [2], [0], [0], [0], [0]], expected=7.0))
    trust = result.reports.trust
    np.testing.assert_array_equal(trust.filled[:, 0], [False, True, True, True, True, True, False, False])
    np.testing.assert_array_equal(trust.measured[:, 0], ~trust.filled[:, 0])
    assert not (trust.learn & trust.filled).any()
    assert (result.channel[:, 0] == FAULT).sum() == 2


def test_rebuild_of_a_channel_that_was_never_healthy() -> None:
    result = walk(rebuilding(1, 1e6), script([[2], [2]], expected=7.0))
    assert (result.channel == FAULT).all()
    assert not result.reports.trust.filled.any()


def test_rebuild_leaves_alone_what_only_a_window_accuses() -> None:
    result = walk(rebuilding(1, 10.0, gates=False), script([[0], [2]], [[1], [5]], expected=7.0))
    assert result.channel[1, 0] == FAULT
    assert result.reports.trust.measured.all()
    np.testing.assert_array_equal(result.reports.trust.value[:, 0], [1, 5])
    np.testing.assert_array_equal(result.reports.trust.learn[:, 0], [True, False])
