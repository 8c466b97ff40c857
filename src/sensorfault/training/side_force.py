"""Fit the side force of a healthy car in turns."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import Log, LogError
from sensorfault.stages.residual.side_force import SLOWEST, SideForce
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import Roles
from sensorfault.vehicles.inertial import SideOn

STALE_S = 1.0  # a speed is valid for this long [s]
GAIN, GAIN_SPREAD = 1.0, 0.1  # prior of the gain: a car rolls by some degrees in a turn of 1 g
INDEPENDENT_S = 1.0  # correlation time of the errors of the side force [s]
LIKELY = 0.5, 1.5  # a gain outside this range means that the unit's axes are wrong


def fit_side_force(log: Log, found: Roles) -> SideForce:
    """Fit a_left = k v ω + level on a healthy drive with turns and changes of speed.

    Raises:
        LogError: no inertial unit or velocity, a car that never moves, turns or changes its speed, or a side force
            that does not match the turn rate.
    """
    mounted = fit_mounting(log, found)
    assert found.gyro is not None
    assert found.accelerometer is not None
    assert found.velocity is not None
    first, second = log.value[:, found.velocity[0]], log.value[:, found.velocity[1]]
    speed = np.abs(first) if found.polar else np.hypot(first, second)
    drift = mounted.axis @ mounted.gyro_bias
    turn = speed * (log.value[:, found.gyro] @ mounted.axis - drift)
    force = log.value[:, found.accelerometer] @ mounted.left
    there = np.isfinite(turn) & np.isfinite(force) & (speed >= SLOWEST)
    there &= log.fresh[:, (*found.gyro, *found.accelerometer)].all(axis=1)
    # a_left = k v ω + level, by least squares with a prior on k: a drive with few turns contains little about it
    inputs = np.stack([turn[there], np.ones(there.sum())], axis=1)
    left = force[there] - inputs @ np.linalg.lstsq(inputs, force[there], rcond=None)[0]
    weight = log.period_s / INDEPENDENT_S / max(float((left**2).mean()), 1e-6)
    known = np.diag([GAIN_SPREAD**-2, 0.0])
    gain, level = np.linalg.solve(
        weight * inputs.T @ inputs + known, weight * inputs.T @ force[there] + known @ [GAIN, 0.0]
    )
    if not LIKELY[0] <= gain <= LIKELY[1]:
        raise LogError(
            f"{log.name}: the side force is {gain:.2f} times speed times turn rate, but should be about equal to it; "
            "check the axes of gyro and accelerometer in vehicle.toml."
        )
    return SideForce(
        unit=SideOn(
            left=jnp.asarray(mounted.left),
            level=jnp.asarray(level),
            up=jnp.asarray(mounted.axis),
            drift=jnp.asarray(drift),
            gyro=found.gyro,
            accelerometer=found.accelerometer,
        ),
        gain=jnp.asarray(gain),
        stale_s=jnp.asarray(STALE_S),
        velocity=found.velocity,
        polar=found.polar,
        channels=len(log.channels),
    )
