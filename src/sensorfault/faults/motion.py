"""Abnormal motion with healthy sensors: side slip, spin, wheel slip.

Each sensor that measures the motion shows it; the others stay unchanged. The result is a log of a vehicle that did move
like that, so a method should report the motion and no sensor.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from sensorfault.faults.fault import FaultError
from sensorfault.logs.table import Log
from sensorfault.numerics.geodesy import ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS

MOTIONS = ("side slip", "spin", "wheel slip")
EDGE_S = 0.5  # a motion begins and ends within this time


@dataclass(frozen=True)
class MotionFault:
    """An abnormal motion from start_s to start_s + duration_s.

    side slip: the vehicle also moves to its left with `magnitude` [m/s] (negative: right), without turning. spin: it
    turns by `magnitude` [rad] to its left and keeps its course. wheel slip: its wheels turn `magnitude` times as fast
    as the ground passes (0: locked).
    """

    kind: str
    start_s: float
    duration_s: float
    magnitude: float

    @property
    def end_s(self) -> float:
        """End of the abnormal motion [s]."""
        return self.start_s + self.duration_s


@dataclass(frozen=True)
class Felt:
    """Columns of the sensors that measure a motion; axes of the inertial unit that point forward, left and up.

    `velocity`: speed over ground and course where `polar`, else north and east. `wheels`: wheel speeds.
    """

    position: tuple[int, int]
    velocity: tuple[int, int]
    polar: bool
    accelerometer: tuple[int, int, int] | None = None
    gyro: tuple[int, int, int] | None = None
    wheels: tuple[int, ...] = ()
    forward: tuple[float, float, float] = (1.0, 0.0, 0.0)
    left: tuple[float, float, float] = (0.0, 1.0, 0.0)
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)


def move(log: Log, fault: MotionFault, felt: Felt) -> Log:
    """The log of a vehicle that moved as `fault` says; the given log is not changed.

    Raises:
        FaultError: an unknown motion, one outside the log, or one that no sensor of the log measures.
    """
    if fault.kind not in MOTIONS:
        raise FaultError(f"no motion is called '{fault.kind}'; take one of {', '.join(MOTIONS)}.")
    if not (log.time[0] <= fault.start_s and fault.duration_s > 0 and fault.end_s <= log.time[-1]):
        raise FaultError(
            f"{log.name}: a {fault.kind} from {fault.start_s:g} to {fault.end_s:g} s is outside the log's "
            f"{log.time[0]:g} to {log.time[-1]:g} s; move it."
        )
    value = log.value.copy()
    if fault.kind == "wheel slip":
        if not felt.wheels:
            raise FaultError(
                f"{log.name} has no wheel speed, so no sensor measures a wheel slip; choose another motion."
            )
        rows = (log.time >= fault.start_s) & (log.time < fault.end_s)
        for column in felt.wheels:
            value[rows, column] *= fault.magnitude
    elif fault.kind == "side slip":
        _slip(log, fault, felt, value)
    else:
        _spin(log, fault, felt, value)
    return replace(log, value=value)


def pulse(time: Float[np.ndarray, " T"], fault: MotionFault) -> Float[np.ndarray, " T"]:
    """0 outside, 1 inside, with smooth edges of EDGE_S inside."""
    edge = min(EDGE_S, fault.duration_s / 2)
    inside = np.minimum(time - fault.start_s, fault.end_s - time) / edge
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.clip(inside, 0.0, 1.0)))


def _slip(log: Log, fault: MotionFault, felt: Felt, value: Float[np.ndarray, "T C"]) -> None:
    """Left of the course: velocity, its integral into the position, its derivative into the accelerometer."""
    heading = _heading(log, felt)
    aside = fault.magnitude * pulse(log.time, fault)
    north, east = aside * np.sin(heading), -aside * np.cos(heading)  # left of a course clockwise from north
    dt = np.diff(log.time, prepend=log.time[0])
    ways = _radians(log, felt, np.cumsum(north * dt), np.cumsum(east * dt))
    for column, way in zip(felt.position, ways, strict=True):
        value[:, column] += _at_fix(log, column, way)
    first, second = felt.velocity
    a, b = log.value[:, first], log.value[:, second]
    to_north, to_east = (a * np.cos(b), a * np.sin(b)) if felt.polar else (a, b)
    to_north, to_east = to_north + _at_fix(log, first, north), to_east + _at_fix(log, first, east)
    slips = _at_fix(log, first, np.abs(aside)) > 0
    if felt.polar:
        course = b + np.angle(np.exp(1j * (np.arctan2(to_east, to_north) - b)))
        to_north, to_east = np.hypot(to_north, to_east), course
    value[slips, first], value[slips, second] = to_north[slips], to_east[slips]
    if felt.accelerometer is not None:
        value[:, felt.accelerometer] += np.gradient(aside, log.time)[:, None] * np.asarray(felt.left)


def _spin(log: Log, fault: MotionFault, felt: Felt, value: Float[np.ndarray, "T C"]) -> None:
    """The gyro measures the turn and the horizontal forces change direction; the path over ground stays."""
    if felt.gyro is None:
        raise FaultError(f"{log.name} has no gyro, so no sensor measures a spin; choose another motion.")
    shape = pulse(log.time, fault)
    total = float(np.trapezoid(shape, log.time))
    rate = fault.magnitude * shape / total
    value[:, felt.gyro] += rate[:, None] * np.asarray(felt.up)
    if felt.accelerometer is not None:
        dt = np.diff(log.time, prepend=log.time[0])
        angle = np.cumsum(rate * dt)
        forward, left = np.asarray(felt.forward), np.asarray(felt.left)
        force = log.value[:, felt.accelerometer]
        ahead, aside = force @ forward, force @ left
        c, s = np.cos(angle), np.sin(angle)
        # the same force in axes turned to the left
        change = np.outer(c * ahead + s * aside - ahead, forward) + np.outer(c * aside - s * ahead - aside, left)
        value[:, felt.accelerometer] += change


def _heading(log: Log, felt: Felt) -> Float[np.ndarray, " T"]:
    """Course over ground at every tick, clockwise from north, without jumps [rad]."""
    first, second = felt.velocity
    rows = log.fresh[:, first] & np.isfinite(log.value[:, [first, second]]).all(axis=1)
    a, b = log.value[rows, first], log.value[rows, second]
    course = np.unwrap(b if felt.polar else np.arctan2(b, a))
    return np.asarray(np.interp(log.time, log.time[rows], course))


def _at_fix(log: Log, column: int, change: Float[np.ndarray, " T"]) -> Float[np.ndarray, " T"]:
    """The change at the time when the value of this row was measured."""
    fresh = log.fresh[:, column]
    source = np.maximum.accumulate(np.where(fresh, np.arange(len(log)), 0))
    return np.asarray(change[source])


def _radians(
    log: Log, felt: Felt, north: Float[np.ndarray, " T"], east: Float[np.ndarray, " T"]
) -> tuple[Float[np.ndarray, " T"], Float[np.ndarray, " T"]]:
    """Latitude and longitude of a point at this distance [m]."""
    latitude = float(np.nanmedian(log.value[:, felt.position[0]]))
    # N = a / √(1 - e² sin²φ),  M = N³ (1 - e²) / a²
    n = SEMI_MAJOR_AXIS / np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(latitude) ** 2)
    m = n**3 * (1 - ECCENTRICITY_SQUARED) / SEMI_MAJOR_AXIS**2
    return north / m, east / (n * np.cos(latitude))
