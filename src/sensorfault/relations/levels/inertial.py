"""Accelerometer and gyro at rest and on average: gravity has one length, and what rests does not turn."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import GRAVITY, Grid
from sensorfault.relations.levels.finding import Finding, device_of, worst
from sensorfault.relations.levels.windows import median_around, median_of_last, windows
from sensorfault.relations.signals import Signal

REST_ACC, REST_RATE, REST_RATE_SD = 0.25, 0.08, 0.03  # at rest: sd of |a|, mean and sd of |rate| over 1 s
REST_M_S = 1.0  # slower than this a vehicle may be at rest
RESTING = 8  # measurements in a second that can show rest
REST_OFF, REST_WINDOWS = 0.8, 3  # gravity at rest may be off by this [m/s^2], median of three windows
FLIGHT_OFF, TILT_RAD = 2.0, 1.05  # mean acceleration over 2 s may differ from g by this, unless the vehicle leans
GYRO_REST = 0.3  # a gyro may read this while a vehicle on wheels stands [rad/s]; less is a matter of calibration
ROUGH_RATE, ROUGH_ACC = 0.7, 2.5  # rougher than this [rad/s, m/s^2] gravity is not to be seen


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of each accelerometer and gyro."""
    for signal in grid.signals.values():
        if signal.role == "accelerometer":
            yield from _gravity(grid, signal, vehicle)
        elif signal.role == "gyro" and vehicle in ("car", "rail"):
            yield from _rate_at_rest(grid, signal)


def _at_rest(grid: Grid, acc: Signal) -> tuple[np.ndarray, np.ndarray]:
    """Windows of 1 s at rest by the inertial unit: centre, and mean length of the acceleration."""
    if "gyro" not in grid:
        return np.zeros(0), np.zeros(0)
    at, mean, sd = windows(acc.time, np.linalg.norm(acc.value, axis=1), 1.0, RESTING)
    gyro = grid.signals["gyro"]
    when, rate, rate_sd = windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 1.0, RESTING)
    if not len(at) or not len(when):
        return np.zeros(0), np.zeros(0)
    still = (sd < REST_ACC) & (np.interp(at, when, rate) < REST_RATE) & (np.interp(at, when, rate_sd) < REST_RATE_SD)
    still &= ~_moving(grid, at)
    return at[still], mean[still]


def _moving(grid: Grid, at: np.ndarray) -> np.ndarray:
    """Times at which a receiver or wheels say that the vehicle moves: to an inertial unit smooth motion is rest."""
    moving = np.zeros(len(at), bool)
    for key in ("gnss.velocity", "gnss.speed", "wheel", "dvl"):
        if key in grid:
            signal = grid.signals[key]
            moving |= np.interp(at, signal.time, np.linalg.norm(signal.value, axis=1)) > REST_M_S
    return moving


def _gravity(grid: Grid, acc: Signal, vehicle: str) -> Iterator[Finding]:
    device = device_of(acc)
    at, length = _at_rest(grid, acc)
    if len(at) >= REST_WINDOWS:
        off = median_of_last(length - GRAVITY, REST_WINDOWS)
        yield from worst(device, at, off, REST_OFF, 1e9, "length of gravity at rest", 0.5, lasting=True)
    if vehicle == "wing" or acc.period_s > 0.5:
        return
    means = [windows(acc.time, acc.value[:, i], 2.0) for i in range(3)]
    at = means[0][0]
    if len(at) < 5:
        return
    off = median_around(np.sqrt(sum(mean**2 for _, mean, _ in means)) - GRAVITY, 2)
    rough = np.max([spread for _, _, spread in means], axis=0) > ROUGH_ACC
    if "gyro" in grid:
        gyro = grid.signals["gyro"]
        when, rate, _ = windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 2.0)
        rough |= np.interp(at, when, rate) > ROUGH_RATE if len(when) else False
    off = np.where(median_around(rough.astype(float), 2) > 0, 0.0, off)
    if "attitude" in grid:
        attitude = grid.signals["attitude"]
        lean = [np.interp(at, attitude.time, np.abs(attitude.value[:, i])) for i in (0, 1)]
        off = np.where(np.maximum(*lean) > TILT_RAD, 0.0, off)
    yield from worst(device, at, off, FLIGHT_OFF, 10.0, "length of gravity over 2 s", 1.0, lasting=True)


def _rate_at_rest(grid: Grid, gyro: Signal) -> Iterator[Finding]:
    number = gyro.key.removeprefix("gyro")
    if f"accelerometer{number}" not in grid:
        return
    acc = grid.signals[f"accelerometer{number}"]
    at, _, sd = windows(acc.time, np.linalg.norm(acc.value, axis=1), 1.0, RESTING)
    when, rate, rate_sd = windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 1.0, RESTING)
    if len(at) < 2 or len(when) < 5:
        return
    still = (np.interp(when, at, sd) < 0.05) & (rate_sd < REST_RATE_SD) & ~_moving(grid, when)
    rate = np.where(still, rate, 0.0)
    yield from worst("gyro" + number, when, median_around(rate, 2), GYRO_REST, 10.0, "rate at rest", 0.5, lasting=True)
