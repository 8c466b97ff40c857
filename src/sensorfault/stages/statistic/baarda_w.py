"""The offset that each channel would have to have for the others to agree, against its standard deviation."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.gaussian import baarda_w
from sensorfault.stages.statistic.per_channel import each


class BaardaW(eqx.Module):
    """|w_i| = |(S⁻¹z)_i| / √(S⁻¹)_ii: one test a channel, standard normal in absolute value. Baarda's w-test (1968).

    S is `residual.cov` of the valid channels, whatever their number; the others are marginalised out. In the bank of
    filters that each leave one out S is diagonal, and w_i = z_i / √S_ii. Wang et al. 2023 compare with it.
    """

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        own = baarda_w(residual.value, residual.cov, residual.valid)
        return each(own.largest * jnp.sqrt(own.taken), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
