"""What side force a healthy car feels when it turns."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import Log, LogError
from sensorfault.stages.residual.side_force import SLOWEST, SideForce
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import Roles
from sensorfault.vehicles.inertial import SideOn

STALE_S = 1.0  # a speed stands for so long
GAIN, GAIN_SPREAD = 1.0, 0.1  # of cars, which lean by some degrees in a bend of 1 g
INDEPENDENT_S = 1.0  # errors of the side force forget each other in about so long
LIKELY = 0.5, 1.5  # a gain beyond: the unit's axes are not what they seem


def fit_side_force(log: Log, found: Roles) -> SideForce:
    """From a healthy drive with turns and changes of speed: a_left = k v ω + level.

    Raises:
        LogError: no inertial unit or velocity, a drive that never moves, turns or changes its speed, or a side force
            that does not follow the turning.
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
    # a_left = k v ω + level, by least squares and what is known of k before: a drive with few turns tells little of it
    inputs = np.stack([turn[there], np.ones(there.sum())], axis=1)
    left = force[there] - inputs @ np.linalg.lstsq(inputs, force[there], rcond=None)[0]
    weight = log.period_s / INDEPENDENT_S / max(float((left**2).mean()), 1e-6)
    known = np.diag([GAIN_SPREAD**-2, 0.0])
    gain, level = np.linalg.solve(
        weight * inputs.T @ inputs + known, weight * inputs.T @ force[there] + known @ [GAIN, 0.0]
    )
    if not LIKELY[0] <= gain <= LIKELY[1]:
        raise LogError(
            f"{log.name}: the side force is {gain:.2f} times speed times turn rate, it should be about once; "
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
