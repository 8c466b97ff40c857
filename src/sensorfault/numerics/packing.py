"""A tree of small arrays as two vectors, so that a scan writes two arrays instead of twelve."""

from typing import Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int8

Tree = TypeVar("Tree")


def pack(tree: object) -> tuple[Float[Array, " n"], Int8[Array, " m"]]:
    """All floating numbers of the tree in one vector, all booleans and small integers (-128 to 127) in another."""
    leaves = [jnp.ravel(leaf) for leaf in jax.tree.leaves(tree)]
    floats = [leaf for leaf in leaves if _floating(leaf.dtype)]
    marks = [leaf.astype(jnp.int8) for leaf in leaves if not _floating(leaf.dtype)]
    return jnp.concatenate([jnp.zeros(0), *floats]), jnp.concatenate([jnp.zeros(0, jnp.int8), *marks])


def unpack(example: Tree, floats: Float[np.ndarray, "T n"], marks: Int8[np.ndarray, "T m"]) -> Tree:
    """The trees whose `pack` are the rows, stacked; `example` has the shapes and types of one of them."""
    leaves, structure = jax.tree.flatten(example)
    at = {True: 0, False: 0}
    stacked = []
    for leaf in leaves:
        kind, size = _floating(leaf.dtype), int(np.prod(leaf.shape))
        columns = (floats if kind else marks)[:, at[kind] : at[kind] + size]
        stacked.append(columns.reshape(-1, *leaf.shape).astype(leaf.dtype, copy=False))
        at[kind] += size
    tree: Tree = jax.tree.unflatten(structure, stacked)
    return tree


def _floating(dtype: Any) -> bool:
    return bool(jnp.issubdtype(dtype, jnp.floating))
