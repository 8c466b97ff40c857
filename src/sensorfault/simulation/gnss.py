"""A consumer GNSS receiver: fixes at a low rate, repeated between fixes."""

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_to_ecef
from sensorfault.simulation.motion import Motion
from sensorfault.simulation.noise import gauss_markov

POSITION_SD, POSITION_S = np.array([1.2, 1.2, 2.5]), 60.0  # error east, north, up [m], correlation time [s]
POSITION_WHITE = 0.05  # [m]
VELOCITY_SD = 0.06  # along and across [m/s]
FROZEN_BELOW = 0.5  # below this speed the course is unknown [m/s]
COURSE_LAG_S = 0.5  # receivers smooth the course
HOLD_EVERY_S, HOLD_S = 60.0, (0.3, 0.6)  # some fixes arrive late
# latitude, longitude [rad], altitude [m], speed [m/s], course [rad]: one count of the output
RESOLUTION = np.array([np.deg2rad(1e-7), np.deg2rad(1e-7), 0.01, 0.01 / 3.6, np.deg2rad(0.01)])


def ideal(m: Motion, origin: tuple[float, float, float]) -> Float[np.ndarray, "T 5"]:
    """Latitude, longitude [rad], altitude [m], speed [m/s], course [rad, from north clockwise, 0 .. 2π], no errors.

    `origin`: latitude, longitude [rad] and altitude [m] of the start; altitude is height above the ellipsoid.
    """
    return _columns(m.position, np.hypot(m.velocity[:, 0], m.velocity[:, 1]), _course(m.heading), origin)


def receive(
    m: Motion, origin: tuple[float, float, float], rate_hz: float, rng: np.random.Generator
) -> tuple[Float[np.ndarray, "T 5"], Bool[np.ndarray, " T"]]:
    """The receiver's output at every tick (columns as in `ideal`), and whether it is a new fix."""
    fresh = due(m.time, rate_hz)
    fresh[1:] &= ~_late(m.time, rng)[1:]
    at = np.flatnonzero(fresh)
    n, step = len(at), 1 / rate_hz
    wander = np.stack([gauss_markov(rng, n, step, POSITION_S) for _ in range(3)], axis=1)
    position = m.position[at] + POSITION_SD * wander + POSITION_WHITE * rng.standard_normal((n, 3))
    along, across = VELOCITY_SD * rng.standard_normal((2, n))
    level = np.hypot(m.velocity[at, 0], m.velocity[at, 1])
    # Speed and direction of the velocity vector with errors along and across.
    speed = np.hypot(level + along, across)
    lagged = np.interp(m.time[at] - COURSE_LAG_S, m.time, m.heading)
    moving = level > FROZEN_BELOW
    moving[0] = True
    last_moving = np.maximum.accumulate(np.where(moving, np.arange(n), 0))
    heading = (lagged + np.arctan2(across, np.maximum(level + along, FROZEN_BELOW))).take(last_moving)
    fix = np.round(_columns(position, speed, _course(heading), origin) / RESOLUTION) * RESOLUTION
    return fix.take(np.cumsum(fresh) - 1, axis=0), fresh


def due(time: Float[np.ndarray, " T"], rate_hz: float) -> Bool[np.ndarray, " T"]:
    """The first tick at or after each multiple of 1 / rate_hz."""
    count = np.floor(time * rate_hz + 1e-6)
    return np.asarray(np.diff(count, prepend=-1.0) > 0)


def _late(time: Float[np.ndarray, " T"], rng: np.random.Generator) -> Bool[np.ndarray, " T"]:
    """Ticks at which the receiver is late."""
    n = rng.poisson(time[-1] / HOLD_EVERY_S)
    begin = np.sort(rng.uniform(0.0, time[-1], n))
    end = begin + rng.uniform(*HOLD_S, n)
    # Inside a hold more have begun than ended.
    return np.searchsorted(begin, time, side="right") > np.searchsorted(np.sort(end), time, side="right")


def _course(heading: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    return np.mod(np.pi / 2 - heading, 2 * np.pi)


def _columns(
    position: Float[np.ndarray, "n 3"],
    speed: Float[np.ndarray, " n"],
    course: Float[np.ndarray, " n"],
    origin: tuple[float, float, float],
) -> Float[np.ndarray, "n 5"]:
    latitude, longitude, altitude = ecef_to_geodetic(enu_to_ecef(position, *origin))
    return np.stack((latitude, longitude, altitude, speed, course), axis=1)
