"""How large the noise of each measurement is taken to be: as stated, or as innovations show it.

Each has `init(r)`; `noise(state, r, innovation, predicted)`, the variance in use [m²], where `predicted` is that of the
innovation without R; and `learn(state, innovation, predicted, taken)`, which remembers what was taken in and no more.
"""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.columns import shifted

LEAST, MOST = 0.1, 100.0  # of the stated variance: what a learned one stays within


class Stated(eqx.Module):
    """R, or with `inflated` R* = R / η: what surprises weighs less at once, each measurement by itself.

    Xu et al. 2023, (30) and (31).
    """

    inflated: bool = eqx.field(static=True, default=False)

    def init(self, r: Float[Array, " M"]) -> tuple[()]:
        return ()

    def noise(
        self, state: tuple[()], r: Float[Array, " M"], innovation: Float[Array, " M"], predicted: Float[Array, " M"]
    ) -> Float[Array, " M"]:
        # η = 1 if r² ≤ P_zz, else P_zz / r²
        return r * jnp.maximum(1.0, innovation**2 / (predicted + r)) if self.inflated else r

    def learn(
        self, state: tuple[()], innovation: Float[Array, " M"], predicted: Float[Array, " M"], taken: Bool[Array, " M"]
    ) -> tuple[()]:
        return ()


class _Learned(NamedTuple):
    r: Float[Array, " M"]
    many: Float[Array, " M"]


class SageHusa(eqx.Module):
    """R as the innovations taken in so far show it, with a memory that fades. Sage & Husa 1969, for scalars.

    `fading`: b < 1; about 1 / (1 - b) measurements are remembered. The stated R counts as the first of them.
    """

    fading: Float[Array, ""]

    def init(self, r: Float[Array, " M"]) -> _Learned:
        return _Learned(r, jnp.zeros_like(r))

    def noise(
        self, state: _Learned, r: Float[Array, " M"], innovation: Float[Array, " M"], predicted: Float[Array, " M"]
    ) -> Float[Array, " M"]:
        return jnp.clip(state.r, LEAST * r, MOST * r)

    def learn(
        self, state: _Learned, innovation: Float[Array, " M"], predicted: Float[Array, " M"], taken: Bool[Array, " M"]
    ) -> _Learned:
        # d = (1 - b) / (1 - b^(k+1)),  R ← (1 - d) R + d (r² - H P Hᵀ)
        d = (1 - self.fading) / (1 - self.fading ** (state.many + 2))
        r = state.r + d * (innovation**2 - predicted - state.r)
        return _Learned(jnp.where(taken, r, state.r), state.many + taken.astype(float))


class WindowedNoise(eqx.Module):
    """R as the mean over the last `length` innovations taken in shows it. Mohamed & Schwarz 1999, from innovations."""

    length: int = eqx.field(static=True)

    def init(self, r: Float[Array, " M"]) -> Float[Array, "K M"]:
        return jnp.ones(self.length)[:, None] * r[None]

    def noise(
        self, state: Float[Array, "K M"], r: Float[Array, " M"], innovation: Float[Array, " M"], predicted: Array
    ) -> Float[Array, " M"]:
        return jnp.clip(state.mean(axis=0), LEAST * r, MOST * r)

    def learn(
        self, state: Float[Array, "K M"], innovation: Float[Array, " M"], predicted: Array, taken: Bool[Array, " M"]
    ) -> Float[Array, "K M"]:
        # R = mean(r² - H P Hᵀ)
        return jnp.where(taken[None], shifted(state, innovation**2 - predicted), state)
