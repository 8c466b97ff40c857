"""The motion of a car from its inertial unit: turn rate and acceleration."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Sample, Trust

STANDING = 0.1  # [m/s]


class Inertial(eqx.Module):
    """Rates of course and speed from a gyro and an accelerometer, fitted by training/mounting.py.

    `yaw`: course rate = yaw . (gyro - gyro_bias), clockwise; `push`: speed rate = push . (force - force_bias).
    `lag_s`: first-order lags of the receiver's course and speed [s]. `gyro`, `accelerometer`: columns.
    """

    yaw: Float[Array, "3"]
    push: Float[Array, "3"]
    gyro_bias: Float[Array, "3"]  # [rad/s]
    force_bias: Float[Array, "3"]  # [m/s^2]
    lag_s: Float[Array, "2"]
    gyro: tuple[int, int, int] = eqx.field(static=True)
    accelerometer: tuple[int, int, int] = eqx.field(static=True)

    def rates(self, sample: Sample) -> tuple[Float[Array, "2"], Bool[Array, ""]]:
        """Course rate [rad/s] and speed rate [m/s^2], and whether they are known; zeros where not."""
        turn = sum(a * (sample.value[i] - b) for a, b, i in zip(self.yaw, self.gyro_bias, self.gyro, strict=True))
        force = zip(self.push, self.force_bias, self.accelerometer, strict=True)
        go = sum(a * (sample.value[i] - b) for a, b, i in force)
        there = jnp.stack([sample.present[i] for i in (*self.gyro, *self.accelerometer)]).all()
        return jnp.where(there, jnp.stack([turn, go]), 0.0), there

    def trusted(self, trust: Trust, fresh: Bool[Array, " C"]) -> Bool[Array, ""]:
        """Whether all new channels of the unit are trusted."""
        return jnp.stack([trust.measured[i] | ~fresh[i] for i in (*self.gyro, *self.accelerometer)]).all()

    def decay(self, dt: Float[Array, ""]) -> Float[Array, "2"]:
        """Remaining share of a first-order lag after dt [s]; 0 where there is no lag."""
        return jnp.where(self.lag_s > 0, jnp.exp(-dt / jnp.where(self.lag_s > 0, self.lag_s, 1.0)), 0.0)


class SideOn(eqx.Module):
    """Side force and turn rate from the same unit, fitted by training/side_force.py.

    Force to the left = left . force - level, anticlockwise rate = up . gyro - drift. `gyro`, `accelerometer`: columns.
    """

    left: Float[Array, "3"]
    level: Float[Array, ""]  # [m/s^2]
    up: Float[Array, "3"]
    drift: Float[Array, ""]  # [rad/s]
    gyro: tuple[int, int, int] = eqx.field(static=True)
    accelerometer: tuple[int, int, int] = eqx.field(static=True)

    def force_and_turn(self, sample: Sample) -> tuple[Float[Array, ""], Float[Array, ""], Bool[Array, ""]]:
        """Force to the left [m/s^2] and turn rate [rad/s], and whether all of the unit is new; zeros where not."""
        there = jnp.stack([sample.fresh[i] for i in (*self.gyro, *self.accelerometer)]).all()
        force = self.left @ jnp.stack([sample.value[i] for i in self.accelerometer]) - self.level
        rate = self.up @ jnp.stack([sample.value[i] for i in self.gyro]) - self.drift
        return jnp.where(there, force, 0.0), jnp.where(there, rate, 0.0), there


def turned(velocity: Float[Array, "2"], by: Float[Array, ""], faster: Float[Array, ""]) -> Float[Array, "2"]:
    """A velocity (east, north) turned clockwise by `by` [rad], with `faster` added to its size [m/s]; never reversed.

    A velocity below STANDING has no direction, so its size is not changed.
    """
    east, north = velocity
    cos, sin = jnp.cos(by), jnp.sin(by)
    speed = jnp.linalg.norm(velocity)
    factor = jnp.where(speed > STANDING, jnp.maximum(speed + faster, 0.0) / jnp.maximum(speed, STANDING), 1.0)
    return jnp.stack([east * cos + north * sin, north * cos - east * sin]) * factor
