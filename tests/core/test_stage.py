"""The last line of defence: no state ever holds what is not finite."""

import jax.numpy as jnp
import numpy as np
import pytest

from laws.damage import holed, telling
from laws.guests.zoo import block, inertial
from laws.walk import assert_same, finite, walk
from sensorfault.core.stage import keep_finite
from sensorfault.core.verdicts import OK, UNKNOWN


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_state_that_is_not_finite_is_not_taken(bad: float) -> None:
    old = {"x": jnp.ones(2), "n": jnp.array([1, 2]), "on": jnp.array(True)}
    new = {"x": jnp.array([3.0, 4.0]), "n": jnp.array([5, 6]), "on": jnp.array(False)}
    assert_same(keep_finite(new, old), new)
    assert_same(keep_finite({**new, "x": jnp.array([3.0, bad])}, old), old)


def test_a_state_without_floats_is_always_taken() -> None:
    assert keep_finite((), ()) == ()
    assert keep_finite((jnp.array(2),), (jnp.array(1),))[0] == 2


def test_a_residual_that_believes_a_nan_costs_one_sample() -> None:
    """A stage that does not look after itself: the sample is unknown, the state is kept, the next is judged."""
    rows = block().rows
    k = telling(block())
    result = walk(inertial(careful=False), holed(rows, k))
    assert finite(result.states)
    np.testing.assert_array_equal(result.channel[k], [UNKNOWN, UNKNOWN])
    assert result.sample[k] == UNKNOWN
    np.testing.assert_array_equal(result.channel[k + 1 :], OK)


def test_a_residual_that_looks_after_itself_pays_in_covariance() -> None:
    rows, k = block().rows, telling(block())
    result, clean = walk(inertial(), holed(rows, k)), walk(inertial(), rows)
    variance, before = (np.diagonal(x.reports.residual.cov[k]) for x in (result, clean))
    assert (variance > before).all()
    np.testing.assert_array_equal(result.channel[k], [OK, OK])
