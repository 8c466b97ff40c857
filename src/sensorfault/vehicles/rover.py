"""A robot on a floor with wheel odometry and ranges to landmarks at known positions."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Sample
from sensorfault.numerics.columns import picked

UNKNOWN_SPEED = 0.3  # standard deviation of a forward velocity that nothing measures [m/s]
UNKNOWN_TURN = 0.6  # and of a turn rate [rad/s]
LOST_M = 100.0  # with a larger position uncertainty, ranges cannot correct the filter any more [m]


class Rover(eqx.Module):
    """State: north and east [m], heading from north to east [rad]. Leung et al. 2011, section 3.

    `landmarks`: north and east of each [m]; `q`: variances that one second of dead reckoning adds to the state;
    `first`: standard deviations of the initial pose. Columns: `observed`, the ranges; `odometry`, forward velocity
    [m/s] and turn rate [rad/s]; `pose`, of the state where it is known.
    """

    landmarks: Float[Array, "M 2"]
    q: Float[Array, "3"]
    first: Float[Array, "3"]
    observed: tuple[int, ...] = eqx.field(static=True)
    odometry: tuple[int, int] = eqx.field(static=True)
    pose: tuple[int, int, int] = eqx.field(static=True)

    def start(self, sample: Sample) -> tuple[Float[Array, "3"], Float[Array, "3"], Bool[Array, ""]]:
        return picked(sample.value, self.pose), self.first, picked(sample.fresh, self.pose).all()

    def ahead(self, state: Float[Array, "3"], sample: Sample, dt: Float[Array, ""]) -> Float[Array, "3"]:
        v, w = jnp.where(picked(sample.present, self.odometry), picked(sample.value, self.odometry), 0.0)
        # x⁺ = x + v Δt cos(θ + ω Δt / 2),  y⁺ = y + v Δt sin(θ + ω Δt / 2),  θ⁺ = θ + ω Δt
        middle = state[2] + w * dt / 2
        return state + dt * jnp.stack([v * jnp.cos(middle), v * jnp.sin(middle), w])

    def noise(
        self, state: Float[Array, "3"], spread: Float[Array, "3"], sample: Sample, dt: Float[Array, ""]
    ) -> Float[Array, "3"]:
        moves, turns = picked(sample.present, self.odometry)
        speed = jnp.where(moves, 0.0, UNKNOWN_SPEED)
        return jnp.sqrt(self.q * dt) + dt * jnp.stack([speed, speed, jnp.where(turns, 0.0, UNKNOWN_TURN)])

    def expected(self, state: Float[Array, "3"], sample: Sample) -> Float[Array, " M"]:
        # r = √(Δx² + Δy²)
        return jnp.sqrt(((self.landmarks - state[:2]) ** 2).sum(axis=1))

    def ready(self, sample: Sample) -> Bool[Array, " M"]:
        return jnp.ones(len(self.observed), bool)

    def lost(self, state: Float[Array, "3"], spread: Float[Array, "3"]) -> Bool[Array, ""]:
        return spread[:2].max() > LOST_M
