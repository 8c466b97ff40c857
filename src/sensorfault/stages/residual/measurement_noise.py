"""How large the noise of each measurement is taken to be: as stated, or larger where an innovation surprises."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class Stated(eqx.Module):
    """R, or with `inflated` R* = R / η: what surprises weighs less at once, each measurement by itself.

    Xu et al. 2023, (30) and (31).
    """

    inflated: bool = eqx.field(static=True, default=False)

    def in_use(
        self, r: Float[Array, " M"], innovation: Float[Array, " M"], predicted: Float[Array, " M"]
    ) -> Float[Array, " M"]:
        """The variance in use [m²]; `predicted` is that of the innovation without R."""
        # η = 1 if r² ≤ P_zz, else P_zz / r²
        return r * jnp.maximum(1.0, innovation**2 / (predicted + r)) if self.inflated else r
