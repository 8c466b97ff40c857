"""Packed in a scan and unpacked after it: the same as stacked by hand."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

import sensorfault.core._jax  # noqa: F401
from sensorfault.numerics.packing import pack, unpack


class Kept(NamedTuple):
    verdict: Any
    scores: tuple[Any, ...]
    flags: Any
    count: Any


def kept(i: Any) -> Kept:
    return Kept(
        jnp.asarray(i % 3, jnp.int8),
        (jnp.sin(i * jnp.arange(3.0)), jnp.asarray(i, float)[None], jnp.full((2, 2), jnp.nan)),
        jnp.array([i > 2, i < 5]),
        jnp.full((2,), i, jnp.int32),
    )


def test_unpacked_is_what_was_packed() -> None:
    rows = jnp.arange(7)
    _, (floats, marks) = lax.scan(lambda carry, i: (carry, pack(kept(i))), 0, rows)
    example = jax.eval_shape(kept, rows[0])
    got = unpack(example, np.asarray(floats), np.asarray(marks))
    wanted = jax.tree.map(lambda *x: np.stack(x), *(kept(i) for i in range(7)))
    assert jax.tree.structure(got) == jax.tree.structure(wanted)
    for mine, other in zip(jax.tree.leaves(got), jax.tree.leaves(wanted), strict=True):
        assert mine.dtype == other.dtype
        np.testing.assert_array_equal(mine, other)


def test_nothing_to_keep_of_a_kind() -> None:
    floats, marks = pack((jnp.ones(2),))
    assert (floats.shape, marks.shape) == ((2,), (0,))
