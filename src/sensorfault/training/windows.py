"""Training examples of a network: windows of consecutive rows, and the target output of each."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Float32, Int, Int32


class Windows(NamedTuple):
    """Window k is rows[first[k] : first[k] + length], with target output `target[k]`; all scaled."""

    rows: Float[np.ndarray, "N C"]
    first: Int[np.ndarray, " M"]
    target: Float[np.ndarray, "M D"]
    length: int

    def matrix(self) -> Float[np.ndarray, "M sC"]:
        """Each window as one row, the oldest of its rows first."""
        return self.rows[self.first[:, None] + np.arange(self.length)].reshape(len(self.first), -1)

    def on_device(self) -> "OnDevice":
        """In float32, as networks are trained."""
        return OnDevice(
            jnp.asarray(self.rows, jnp.float32),
            jnp.asarray(self.first, jnp.int32),
            jnp.asarray(self.target, jnp.float32),
        )


class OnDevice(NamedTuple):
    """Windows as the compiled training takes them."""

    rows: Float32[Array, "N C"]
    first: Int32[Array, " M"]
    target: Float32[Array, "M D"]

    def batch(self, chosen: Int32[Array, " B"], length: int) -> tuple[Float32[Array, "s C B"], Float32[Array, "D B"]]:
        """Some of the windows and their targets, side by side on the last axis."""
        at = self.first[chosen][None] + jnp.arange(length, dtype=jnp.int32)[:, None]
        return self.rows[at].transpose(0, 2, 1), self.target[chosen].T
