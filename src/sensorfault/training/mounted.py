"""The inertial unit of a car with the mounting that was found for it."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.training.mounting import Mounting
from sensorfault.vehicles.car import Roles
from sensorfault.vehicles.inertial import Inertial


def inertial(mounting: Mounting, found: Roles) -> Inertial:
    """The inertial unit with this mounting; a negative lag of the receiver counts as 0."""
    assert found.gyro is not None
    assert found.accelerometer is not None
    return Inertial(
        yaw=jnp.asarray(mounting.yaw),
        push=jnp.asarray(mounting.thrust * mounting.forward),
        gyro_bias=jnp.asarray(mounting.gyro_bias),
        force_bias=jnp.asarray(mounting.accelerometer_bias),
        lag_s=jnp.asarray(np.maximum([mounting.course_lag_s, mounting.speed_lag_s], 0.0)),
        gyro=found.gyro,
        accelerometer=found.accelerometer,
    )
