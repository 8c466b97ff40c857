"""How far off a healthy prediction can be, and three deviations of the sensor's noise beyond."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class Sigma(eqx.Module):
    """theta_i = Delta_i + 3 sigma_i with Delta_i = rho_i dt, one test a channel. Niu & Zhao 1998, section 2.

    The paper bounds Delta, the largest error of a prediction, by rho, the largest slope of the output itself.
    """

    rho: Float[Array, " K"]  # the fastest that the output, or the error of its prediction, moves [SI/s]
    sigma: Float[Array, " K"]  # of the sensor's noise [SI]
    tick_s: Float[Array, ""]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        return self.limit(), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()

    def limit(self) -> Float[Array, " K"]:
        """theta, which no sample changes."""
        # theta_i = rho_i dt + 3 sigma_i
        return self.rho * self.tick_s + 3 * self.sigma
