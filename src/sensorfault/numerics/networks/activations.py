"""Activation functions by name, so that a fitted network can be written to a file and read back."""

from collections.abc import Callable

import jax
from jaxtyping import Array, Float

ACTIVATIONS: dict[str, Callable[[Float[Array, "*n"]], Float[Array, "*n"]]] = {
    "identity": lambda x: x,
    "sigmoid": jax.nn.sigmoid,
    "tanh": jax.numpy.tanh,
    "relu": jax.nn.relu,
}
