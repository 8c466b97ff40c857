"""Condition (a): track and inertial unit of a real drive, with simulated satellites."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int
from scipy.interpolate import make_smoothing_spline

from sensorfault.logs import read
from sensorfault.logs.table import Log
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes, geodetic_to_ecef
from sensorfault.numerics.gnss.constellation import walker
from sensorfault.simulation import pseudorange, receiver_clock
from sensorfault.simulation.pseudorange import Noise
from sensorfault.simulation.ride import Ride, recorded
from sensorfault.simulation.sky import Sky, overhead
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import roles
from sensorfault_studies.data import real

FOLDER = "road/gnss_imu_drive0708"
# Lag of the inertial unit's rows behind the positions, for which both turns and forces fit best. (Behind the receiver's
# velocities it is half of that, because these are averages over the quarter of a second before.)
IMU_LATE_S = 0.25
START_S, EPOCHS = 56.0, 413  # from the time when the car moves at 8 m/s
TICKS = 100  # ticks of the inertial unit between two satellite epochs
USED = 9
# GPS time at the start, with nine satellites above 18°. Of six hours tried this one reproduces an earlier version of
# this study: a limit on each innovation detects 64 and 90 % of steps of 10 and 15 m.
SKY_S = 18_000.0
SMOOTHING = 1e-3  # of the spline; its residual is 4 mm, and the last digit of the positions is 1 cm
LEAST_SPEED = 1.0  # a slower car keeps its heading [m/s]


def drive(noise: Noise, seed: int) -> Ride:
    """The drive from second 56 on, 413 epochs at 1 Hz; only the pseudorange errors depend on the seed.

    The nine highest of 36 satellites are used. The inertial unit is as recorded, rotated to forward, right and down by
    `fit_mounting`; the attitude in the truth is that of the track (roll 0).

    Raises:
        LogError: the real drive does not exist.
    """
    base = _base(real(FOLDER))
    error = pseudoranges(noise, [seed])[0]
    rate_error = pseudorange.rate_errors([seed], base.sky.elevation)[0]
    name = f"drive0708 {noise} {seed}"
    log = recorded(name, base.time, base.inertial, base.epochs, base.sky, base.clock, error, rate_error)
    return Ride(log, base.position, base.velocity, base.attitude, base.clock, base.epochs, base.sky, error)


def pseudoranges(noise: Noise, seeds: Sequence[int]) -> Float[np.ndarray, "N E S"]:
    """Only the pseudorange errors of these seeds [m]; apart from Doppler, everything else is equal in their drives.

    Raises:
        LogError: the real drive does not exist.
    """
    return pseudorange.errors(noise, seeds, _base(real(FOLDER)).sky.elevation)


@dataclass(frozen=True)
class _Base:
    """The data that all seeds share: T ticks, E epochs."""

    time: Float[np.ndarray, " T"]
    inertial: Float[np.ndarray, "T 6"]
    position: Float[np.ndarray, "T 3"]
    velocity: Float[np.ndarray, "T 3"]
    attitude: Float[np.ndarray, "T 3 3"]
    clock: Float[np.ndarray, "T 2"]
    epochs: Int[np.ndarray, " E"]
    sky: Sky


@cache
def _base(folder: Path) -> _Base:
    log = read(folder)
    first = int(np.searchsorted(log.time, START_S))
    rows = slice(first, first + (EPOCHS - 1) * TICKS + 1)
    time = log.time[rows] - log.time[first]
    position, velocity = _track(log, log.time[rows] - IMU_LATE_S)
    epochs = np.arange(0, len(time), TICKS)
    sky = overhead(walker(), SKY_S + time[epochs], position[epochs], velocity[epochs])
    highest = np.zeros(len(sky.names), bool)
    highest[np.argsort(-sky.elevation[0])[:USED]] = True
    clock = receiver_clock.wander(np.random.default_rng(0), time)
    attitude = _along(position, velocity)
    return _Base(time, _inertial(log)[rows], position, velocity, attitude, clock, epochs, sky.only(highest))


def _track(log: Log, at: Float[np.ndarray, " T"]) -> tuple[Float[np.ndarray, "T 3"], Float[np.ndarray, "T 3"]]:
    """Position and velocity, ECEF [m], [m/s], at these times of the receiver."""
    columns = [log.index(f"gnss.{name}") for name in ("latitude", "longitude", "height")]
    fixes = log.fresh[:, columns[0]]
    place = geodetic_to_ecef(*log.value[fixes][:, columns].T)
    start = place[0].copy()
    splines = [make_smoothing_spline(log.time[fixes], axis, lam=SMOOTHING) for axis in (place - start).T]
    position = start + np.stack([spline(at) for spline in splines], axis=1)
    return position, np.stack([spline(at, 1) for spline in splines], axis=1)


def _inertial(log: Log) -> Float[np.ndarray, "T 6"]:
    """Angular rate and specific force, forward, right, down."""
    found = roles(log)
    mounting = fit_mounting(log, found)
    assert found.gyro is not None
    assert found.accelerometer is not None
    body = np.stack([mounting.forward, -mounting.left, -mounting.axis])
    return np.concatenate([log.value[:, found.gyro] @ body.T, log.value[:, found.accelerometer] @ body.T], axis=1)


def _along(position: Float[np.ndarray, "T 3"], velocity: Float[np.ndarray, "T 3"]) -> Float[np.ndarray, "T 3 3"]:
    """Rotation from body to ECEF of a vehicle that points in its direction of motion, without roll."""
    moving = np.linalg.norm(velocity, axis=1) > LEAST_SPEED
    last = np.maximum.accumulate(np.where(moving, np.arange(len(moving)), 0))
    forward = velocity[last] / np.linalg.norm(velocity[last], axis=1, keepdims=True)
    latitude, longitude, _ = ecef_to_geodetic(position)
    right = np.cross(forward, enu_axes(latitude, longitude)[:, 2])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    return np.stack([forward, right, np.cross(forward, right)], axis=2)
