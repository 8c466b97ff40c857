"""Averaged innovation (AIME) of each satellite, the others' taken into account."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.stages.statistic.information import Information
from sensorfault.stages.statistic.per_channel import each


class AveragedBaardaW(eqx.Module):
    """|(V⁻¹z̄)_i| / √(V⁻¹)_ii with V⁻¹ = ΣS⁻¹ and V⁻¹z̄ = ΣS⁻¹z over the last `window_s`: the w-test of the average.

    One test a channel, standard normal in absolute value where innovations are white, from its first sample on. Of one
    sample it is Baarda's; averaged_innovation.py is what is left of it where S is diagonal.
    """

    window_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True)

    def init(self) -> Information:
        return Information.empty(self.slots, self.channels)

    def evaluate(self, state: Information, residual: Residual) -> tuple[Score, Information]:
        (matrix, vector), after = state.taken(residual, self.window_s)
        information = (jnp.eye(self.channels) * matrix).sum(axis=1)
        value = jnp.abs(vector) / jnp.sqrt(jnp.where(information > 0, information, jnp.inf))
        return each(value, residual.valid & (information > 0)), after

    def update(self, pending: Information, trust: Trust) -> Information:
        return pending
