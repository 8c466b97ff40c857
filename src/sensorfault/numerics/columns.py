"""Select channels and shift rows without a gather, which costs more in a small loop."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jaxtyping import Array


def picked(each: Array, columns: tuple[int, ...]) -> Array:
    """These columns of a vector over channels."""
    return jnp.stack([each[i] for i in columns]) if columns else each[:0]


def shifted(rows: Array, newest: Array) -> Array:
    """The rows without the first (oldest), with this one appended."""
    return jnp.concatenate([rows[1:], newest[None]])
