"""Some channels out of all, and rows that move up: without a gather, which costs more in a small loop."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jaxtyping import Array


def picked(each: Array, columns: tuple[int, ...]) -> Array:
    """These columns out of one number a channel."""
    return jnp.stack([each[i] for i in columns]) if columns else each[:0]


def shifted(rows: Array, newest: Array) -> Array:
    """The rows without the first, the oldest, and with this one behind the last."""
    return jnp.concatenate([rows[1:], newest[None]])
