"""A train or another ground vehicle with satellite receiver and inertial unit: the noise of its instruments."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.ins_error import ACC, CLOCK, DRIFT, GYRO, PSI, VEL
from sensorfault.numerics.strapdown import Way

UNKNOWN_TURN = 0.1  # random walk of the heading without a gyro [rad/√s]


class Grade(eqx.Module):
    """White noise and random walk of the inertial unit and of the receiver's clock, as densities.

    `gyro` [rad/√s], `force` [m/s/√s], their biases' walk [rad/s/√s], [m/s²/√s]; `clock` [m/√s], `drift` [m/s/√s].
    `gyro_bias` [rad/s] and `force_bias` [m/s²]: standard deviations of the initial biases.
    `motion`: random walk of the velocity without an inertial unit [m/s/√s].
    """

    gyro: Float[Array, ""]
    force: Float[Array, ""]
    gyro_walk: Float[Array, ""]
    force_walk: Float[Array, ""]
    clock: Float[Array, ""]
    drift: Float[Array, ""]
    gyro_bias: Float[Array, ""]
    force_bias: Float[Array, ""]
    motion: Float[Array, ""]

    def added(self, way: Way, states: int) -> Float[Array, " n"]:
        """Variances that a stretch of time adds, to first order."""
        seen, index = way.time - way.blind, jnp.arange(states)
        parts = (
            (PSI, self.gyro**2 * seen + UNKNOWN_TURN**2 * way.blind),
            (VEL, self.force**2 * seen + self.motion**2 * way.blind),
            (GYRO, self.gyro_walk**2 * way.time),
            (ACC, self.force_walk**2 * way.time),
            (slice(CLOCK, CLOCK + 1), self.clock**2 * way.time),
            (slice(DRIFT, DRIFT + 1), self.drift**2 * way.time),
        )
        q = jnp.zeros(states)
        for at, variance in parts:
            q = q + jnp.where((index >= at.start) & (index < at.stop), variance, 0.0)
        return q


class ElevationNoise(eqx.Module):
    """σ = factor (zenith + horizon exp(-el / scale)) of a pseudorange [m], elevations in rad."""

    zenith: Float[Array, ""]
    horizon: Float[Array, ""]
    scale: Float[Array, ""]
    factor: Float[Array, ""]

    def variance(self, elevation: Float[Array, " S"], cn0: Float[Array, " S"]) -> Float[Array, " S"]:
        sigma = self.factor * (self.zenith + self.horizon * jnp.exp(-jnp.maximum(elevation, 0.0) / self.scale))
        return sigma**2


class CarrierNoise(eqx.Module):
    """σ² = floor² + slope 10^(-C/N0 / 10) of a pseudorange [m²]; 30 dB-Hz is assumed where C/N0 is unknown.

    Source: Kuusniemi & Lachapelle, ION GNSS 2004, an alternative that Wang et al. 2023 cite.
    """

    floor: Float[Array, ""]
    slope: Float[Array, ""]

    def variance(self, elevation: Float[Array, " S"], cn0: Float[Array, " S"]) -> Float[Array, " S"]:
        return self.floor**2 + self.slope * 10 ** (-jnp.where(jnp.isfinite(cn0), cn0, 30.0) / 10)
