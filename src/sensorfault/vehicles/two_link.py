"""The motion of two joints in a vertical plane."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.two_link import Constants, ahead


class TwoLink(eqx.Module):
    """An arm of two joints, by its five constants. Niu & Zhao 1998, equations (3) and (4)."""

    a: Float[Array, "5"]

    @classmethod
    def of(cls, constants: Constants) -> "TwoLink":
        """With these constants."""
        return cls(jnp.asarray(constants, float))

    def ahead(self, state: Float[Array, "4"], torque: Float[Array, "2"], dt: Float[Array, ""]) -> Float[Array, "4"]:
        """Rates [rad/s] and angles [rad] after `dt` [s] under these torques [N m]."""
        return jnp.asarray(ahead(self.a, state, torque, dt))
