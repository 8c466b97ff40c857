"""As far as a healthy output can go in one tick, and three deviations of its noise beyond."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.types import Residual, Score, Trust


class Sigma(eqx.Module):
    """theta_i = Delta_i + 3 sigma_i with Delta_i = rho_i dt, one test a channel. Niu & Zhao 1998."""

    rho: Float[Array, " K"]  # the largest slope [SI/s]
    sigma: Float[Array, " K"]  # [SI]
    tick_s: Float[Array, ""]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        # theta_i = rho_i dt + 3 sigma_i
        return self.rho * self.tick_s + 3 * self.sigma, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
