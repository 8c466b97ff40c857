"""Mounting of the inertial unit in the car and lags of the receiver, from a healthy drive alone."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError
from sensorfault.vehicles.car import Roles

WINDOW_S = 1.0  # changes of course and speed are compared over this time [s]
LEAST_SPEED = 3.0  # a slower car's course is not used [m/s]
LATEST_S = 2.0  # lags are sought from -0.5 s to this [s]
STEP_S = 0.05  # ... on this grid [s]
LEAST_MOVING_S = 20.0  # the drive must move for so long [s]
_TURN, _GO = 0.02, 0.3  # smallest RMS rate of course [rad/s] and of speed [m/s^2] that shows an axis


@dataclass(frozen=True)
class Mounting:
    """Axes of the inertial unit and lags of the receiver.

    `up`, `forward`: unit vectors in the unit's axes.
    Course rate = yaw_sign * up . (gyro - gyro_bias), clockwise from north: -1 for a right-handed gyro.
    Speed rate = thrust * forward . (accelerometer - accelerometer_bias); the bias contains the mean gravity; `thrust`
    is below 1 because a braking car pitches, which adds a part of gravity.
    `course_lag_s`, `speed_lag_s`: the receiver's value at t belongs to t - lag on the inertial unit's clock.
    `course_rms`, `speed_rms`: RMS residual of the rates over one second [rad/s], [m/s^2].
    """

    up: Float[np.ndarray, "3"]
    forward: Float[np.ndarray, "3"]
    gyro_bias: Float[np.ndarray, "3"]
    accelerometer_bias: Float[np.ndarray, "3"]
    yaw_sign: float
    thrust: float
    course_lag_s: float
    speed_lag_s: float
    course_rms: float
    speed_rms: float

    @property
    def yaw(self) -> Float[np.ndarray, "3"]:
        """course rate = yaw . (gyro - gyro_bias)."""
        return self.yaw_sign * self.up

    @property
    def axis(self) -> Float[np.ndarray, "3"]:
        """Axis about which a positive rate of the gyro turns the car anticlockwise.

        Equal to `up`, except for units that report gravity with the opposite sign of other forces (Dresden, a phone).
        """
        return -self.yaw_sign * self.up

    @property
    def left(self) -> Float[np.ndarray, "3"]:
        """Unit vector to the left: axis cross forward."""
        return np.cross(self.axis, self.forward)


class _Motion(NamedTuple):
    """When the drive is fast enough, and the rates of course and speed over the WINDOW_S before."""

    at: Float[np.ndarray, " M"]
    course_rate: Float[np.ndarray, " M"]
    speed_rate: Float[np.ndarray, " M"]


def fit_mounting(log: Log, found: Roles) -> Mounting:
    """Fit the mounting on a healthy drive with turns and changes of speed.

    Raises:
        LogError: no inertial unit or velocity, or a car that never moves, turns or changes its speed.
    """
    at, course_rate, speed_rate = check_mounting(log, found)
    assert found.gyro is not None
    assert found.accelerometer is not None
    gyro, force = _sums(log, found.gyro), _sums(log, found.accelerometer)
    mean = np.nanmean(log.value[:, found.accelerometer], axis=0)
    up = mean / np.linalg.norm(mean)

    # course rate = s up . (gyro - bias), at the lag with the smallest residual
    course_lag, (slope, level), course_rms = _lagged(at, course_rate, log.time, gyro @ up[:, None])
    sign = 1.0 if slope > 0 else -1.0
    gyro_mean = np.nanmean(log.value[:, found.gyro], axis=0)
    gyro_bias = gyro_mean - up * (up @ gyro_mean) - up * level / slope

    # speed rate = thrust f . (force - bias), f across up
    across = np.linalg.svd(up[None])[2][1:]
    speed_lag, fitted, speed_rms = _lagged(at, speed_rate, log.time, force @ across.T)
    thrust = float(np.linalg.norm(fitted[:2]))
    forward = fitted[:2] @ across / thrust
    force_bias = mean - forward * (forward @ mean) - forward * fitted[2] / thrust
    return Mounting(up, forward, gyro_bias, force_bias, sign, thrust, course_lag, speed_lag, course_rms, speed_rms)


def check_mounting(log: Log, found: Roles) -> _Motion:
    """Check that the log has the channels and the motion that the fit needs, without fitting.

    Raises:
        LogError: as `fit_mounting`.
    """
    if found.gyro is None or found.accelerometer is None or found.velocity is None:
        what = "gyro with x, y, z" if found.gyro is None else "accelerometer with x, y, z"
        what = "velocity over ground (speed and course, or north and east)" if found.velocity is None else what
        raise LogError(f"{log.name} has no {what}, which is needed to find how the inertial unit is mounted.")
    time, speed, course = _ground(log, found)
    at = np.arange(log.time[0] + LATEST_S + WINDOW_S, log.time[-1] - 1.0, STEP_S)
    ends = np.stack([np.interp(at, time, speed), np.interp(at - WINDOW_S, time, speed)])
    at = at[(ends > LEAST_SPEED).all(axis=0)]
    if len(at) * STEP_S < LEAST_MOVING_S:
        raise LogError(
            f"{log.name} moves faster than {LEAST_SPEED:g} m/s for {len(at) * STEP_S:.0f} s, but finding the unit's "
            f"mounting needs {LEAST_MOVING_S:g} s; give a drive that moves."
        )
    course_rate, speed_rate = (_rate(at, time, x) for x in (course, speed))
    for name, rate, least, unit in (
        ("turns", course_rate, _TURN, "rad/s"),
        ("changes its speed", speed_rate, _GO, "m/s^2"),
    ):
        if np.sqrt((rate**2).mean()) < least:
            raise LogError(f"{log.name} hardly {name} (below {least:g} {unit}); give a drive with corners and stops.")
    return _Motion(at, course_rate, speed_rate)


def _ground(log: Log, found: Roles) -> tuple[Float[np.ndarray, " N"], Float[np.ndarray, " N"], Float[np.ndarray, " N"]]:
    """Time [s], speed [m/s] and course without jumps [rad] of each new velocity."""
    assert found.velocity is not None
    first, second = found.velocity
    rows = log.fresh[:, first] & np.isfinite(log.value[:, [first, second]]).all(axis=1)
    a, b = log.value[rows, first], log.value[rows, second]
    speed, course = (a, b) if found.polar else (np.hypot(a, b), np.arctan2(b, a))
    return log.time[rows], speed, np.unwrap(course)


def _sums(log: Log, columns: tuple[int, int, int]) -> Float[np.ndarray, "T 3"]:
    """Integral over time of three columns from the first row on; gaps are interpolated."""
    sums = np.zeros((len(log), 3))
    for k, column in enumerate(columns):
        there = np.isfinite(log.value[:, column])
        value = np.interp(log.time, log.time[there], log.value[there, column])
        sums[1:, k] = np.cumsum((value[1:] + value[:-1]) / 2 * np.diff(log.time))
    return sums


def _rate(at: Float[np.ndarray, " M"], time: Float[np.ndarray, " N"], x: Float[np.ndarray, " N"]) -> np.ndarray:
    """Mean rate of x over the WINDOW_S before each time."""
    return np.asarray((np.interp(at, time, x) - np.interp(at - WINDOW_S, time, x)) / WINDOW_S)


def _lagged(
    at: Float[np.ndarray, " M"], rate: np.ndarray, time: Float[np.ndarray, " T"], sums: Float[np.ndarray, "T n"]
) -> tuple[float, np.ndarray, float]:
    """rate(t) = b . mean of the inputs `lag` earlier + level: the best lag [s], (b, level), and the RMS residual."""
    best = np.inf, 0.0, np.zeros(0)
    for lag in np.arange(-0.5, LATEST_S, STEP_S):
        inputs = np.stack([_rate(at - lag, time, column) for column in sums.T] + [np.ones(len(at))], axis=1)
        kept = np.ones(len(at), bool)
        for _ in range(3):  # the course jumps when a car starts; such outliers are left out
            fitted = np.linalg.lstsq(inputs[kept], rate[kept], rcond=None)[0]
            left = np.abs(rate - inputs @ fitted)
            kept = left <= 4 * np.median(left) + 1e-12
        score = float(np.median(left))
        if score < best[0]:
            best = score, float(lag), fitted
            rms = float(np.sqrt((left[kept] ** 2).mean()))
    return best[1], best[2], rms
