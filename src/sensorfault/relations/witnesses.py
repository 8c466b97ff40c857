"""What the sensors say of each quantity, on the grid: measured, integrated once or integrated twice.

A witness returns T numbers, or None where its sensors are not there or too slow.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from sensorfault.relations.grid import GRAVITY, Grid, angle_rates, integrated, to_local, unwrapped
from sensorfault.relations.signals import Signal

Witness = Callable[[Grid], "Float[np.ndarray, ' T'] | None"]
FAST_S = 0.06  # an accelerometer sampled more slowly folds vibration into motion
SLOW_FAST_S = 0.21  # allowed where the vehicle does not vibrate
# Leaning further or rocking faster, what is left of iron and of levelling moves a compass.
COMPASS_LEAN_RAD, COMPASS_ROCK_RAD_S = 0.6, 0.7
MOVING_M_S = 3.0  # slower than this a course is noise


def measured(key: str, column: int = 0) -> Witness:
    """The signal itself."""
    return lambda grid: grid.value(key)[:, column] if key in grid else None


def summed(key: str, column: int = 0) -> Witness:
    """The integral of the signal."""
    return lambda grid: grid.integral(key)[:, column] if key in grid else None


def pulled(column: int, order: int, number: str = "") -> Witness:
    """Acceleration turned into north, east, up, integrated `order` times."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        key = "accelerometer" + number
        if key not in grid or "attitude" not in grid or grid.signals["attitude"].value.shape[1] < 3:
            return None
        acc, attitude = grid.signals[key], grid.signals["attitude"]
        if acc.period_s > grid.facts.get("acceleration.period", FAST_S):
            return None
        return grid.keep(f"pulled {number} {order}", lambda: _pulled(grid, key, acc, attitude, order))[:, column]

    return witness


def _pulled(grid: Grid, key: str, acc: Signal, attitude: Signal, order: int) -> Float[np.ndarray, "T 3"]:
    roll, pitch = (np.interp(acc.time, attitude.time, attitude.value[:, i]) for i in (0, 1))
    yaw = np.interp(acc.time, attitude.time, np.unwrap(attitude.value[:, 2]))
    local = to_local(np.stack([roll, pitch, yaw], axis=1), acc.value)
    # a = f + g; up is minus down
    local = np.stack([local[:, 0], local[:, 1], -(local[:, 2] + GRAVITY)], axis=1)
    for _ in range(order):
        local = integrated(acc.time, local)
    on = grid.put(key, local)
    on[grid.hole("attitude")] = np.nan
    return on


def turned(column: int, number: str = "") -> Witness:
    """Roll, pitch or yaw from the gyro alone; roll and pitch of the attitude only say how the vehicle leans."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        key = "gyro" + number
        if key not in grid:
            return _yaw_rate(grid) if column == 2 and not number else None
        return grid.keep(f"turned {number}", lambda: _turned(grid, key))[:, column]

    return witness


def _turned(grid: Grid, key: str) -> Float[np.ndarray, "T 3"]:
    gyro = grid.signals[key]
    lean = np.zeros((2, len(gyro.time)))
    if "attitude" in grid:
        attitude = grid.signals["attitude"]
        lean = np.stack([np.interp(gyro.time, attitude.time, attitude.value[:, i]) for i in (0, 1)])
    return grid.put(key, integrated(gyro.time, angle_rates(lean[0], lean[1], gyro.value)))


def _yaw_rate(grid: Grid) -> Float[np.ndarray, " T"] | None:
    return grid.integral("yaw_rate")[:, 0] if "yaw_rate" in grid else None


def angle(key: str, column: int) -> Witness:
    """A measured angle without jumps of a whole turn."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        if key not in grid or grid.signals[key].value.shape[1] <= column:
            return None
        signal = grid.signals[key]
        return grid.put(key, unwrapped(signal.value[:, column])[:, None])[:, 0]

    return witness


def compass(number: str = "") -> Witness:
    """Heading from the magnetic field, levelled by roll and pitch (declination is a constant)."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        key = "magnetometer" + number
        if key not in grid or "attitude" not in grid or not grid.facts.get("mounted", 1.0):
            return None
        if not np.ptp(grid.signals[key].value, axis=0).any():
            return None
        (x, y, z), lean = grid.value(key).T, grid.value("attitude")
        sr, cr, sp, cp = np.sin(lean[:, 0]), np.cos(lean[:, 0]), np.sin(lean[:, 1]), np.cos(lean[:, 1])
        forward, right = x * cp + y * sr * sp + z * cr * sp, y * cr - z * sr
        rocking = np.abs(np.gradient(lean[:, :2], grid.time, axis=0)).max(axis=1)
        upright = (np.abs(lean[:, :2]).max(axis=1) < COMPASS_LEAN_RAD) & (rocking < COMPASS_ROCK_RAD_S)
        return unwrapped(np.where(upright, np.arctan2(-right, forward), np.nan))

    return witness


def course(device: str) -> Witness:
    """Direction of the receiver's velocity while the vehicle moves: of vehicles that go where they point."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        if f"{device}.velocity" in grid:
            north, east = grid.value(f"{device}.velocity").T
            return unwrapped(np.where(np.hypot(north, east) > MOVING_M_S, np.arctan2(east, north), np.nan))
        if f"{device}.course" not in grid or f"{device}.speed" not in grid:
            return None
        direction = grid.put(f"{device}.course", unwrapped(grid.signals[f"{device}.course"].value[:, 0])[:, None])[:, 0]
        return unwrapped(np.where(grid.value(f"{device}.speed")[:, 0] > MOVING_M_S, direction, np.nan))

    return witness


def path(device: str) -> Witness:
    """Way along the positions: the mean of the ways that begin at each measurement of a second and step by a second."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        key = f"{device}.position"
        if key not in grid:
            return None
        signal = grid.signals[key]
        every = max(1, round(1.0 / signal.period_s))
        step = np.zeros(len(signal.time))
        step[every:] = np.hypot(*(signal.value[every:] - signal.value[:-every]).T) / every
        return grid.put(key, np.cumsum(step)[:, None])[:, 0]

    return witness


def run(device: str, order: int) -> Witness:
    """Speed over ground by the receiver, or its integral."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        for key in (f"{device}.velocity", f"{device}.speed"):
            if key in grid:
                signal = grid.signals[key]
                speed = np.linalg.norm(signal.value, axis=1, keepdims=True)
                return grid.put(key, integrated(signal.time, speed) if order else speed)[:, 0]
        return None

    return witness


def pushed(grid: Grid) -> Float[np.ndarray, " T"] | None:
    """Integral of the forward acceleration of a vehicle that stays level."""
    if "accelerometer" not in grid or "attitude" in grid or not grid.facts.get("forward", 1.0):
        return None
    if grid.signals["accelerometer"].period_s > SLOW_FAST_S:
        return None
    return grid.integral("accelerometer")[:, 0]


def velocity(column: int, device: str) -> Witness:
    """North or east velocity: measured, or from speed and course."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        both = grid.keep(f"velocity {device}", lambda: _velocity(grid, False, device))
        return None if both is None else both[:, column]

    return witness


def displaced(column: int, device: str) -> Witness:
    """Integral of the receiver's velocity: measured, or from its speed and course."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        both = grid.keep(f"displaced {device}", lambda: _velocity(grid, True, device))
        return None if both is None else both[:, column]

    return witness


def _velocity(grid: Grid, way: bool, device: str) -> Float[np.ndarray, "T 2"] | None:
    if f"{device}.velocity" in grid:
        return grid.integral(f"{device}.velocity") if way else grid.value(f"{device}.velocity")
    speed, direction = grid.signals.get(f"{device}.speed"), grid.signals.get(f"{device}.course")
    if speed is None or direction is None:
        return None
    to = np.interp(speed.time, direction.time, unwrapped(direction.value[:, 0]))
    velocity = speed.value * np.stack([np.cos(to), np.sin(to)], axis=1)
    return grid.put(speed.key, integrated(speed.time, velocity) if way else velocity)


def reckoned(column: int) -> Witness:
    """Way by wheels or a Doppler log, turned by heading: dead reckoning, north or east."""

    def witness(grid: Grid) -> Float[np.ndarray, " T"] | None:
        way = grid.keep("reckoned", lambda: _reckoned(grid))
        return None if way is None else way[:, column]

    return witness


def _reckoned(grid: Grid) -> Float[np.ndarray, "T 2"] | None:
    if "dvl" not in grid or ("heading" not in grid and "attitude" not in grid):
        return None
    speed = grid.signals["dvl"]
    by = grid.signals["heading"] if "heading" in grid else grid.signals["attitude"]
    yaw = np.interp(speed.time, by.time, unwrapped(by.value[:, -1]))
    forward, right = speed.value[:, 0], speed.value[:, 1]
    north, east = forward * np.cos(yaw) - right * np.sin(yaw), forward * np.sin(yaw) + right * np.cos(yaw)
    return grid.put("dvl", integrated(speed.time, np.stack([north, east], axis=1)))


def _speed(grid: Grid) -> "tuple[Float[np.ndarray, ' n'], Float[np.ndarray, ' n']] | None":
    """Time and speed of a vehicle on wheels, by its wheels or else by its receiver."""
    if "wheel" in grid:
        return grid.signals["wheel"].time, grid.signals["wheel"].value[:, 0]
    for key in ("gnss.speed", "gnss.velocity"):
        if key in grid:
            return grid.signals[key].time, np.linalg.norm(grid.signals[key].value, axis=1)
    return None


def steered(grid: Grid) -> Float[np.ndarray, " T"] | None:
    """Yaw by the steering: integral of speed times angle times a fitted gain, one over ratio times wheelbase."""
    speed = _speed(grid)
    if "steering" not in grid or speed is None or "steering.gain" not in grid.facts:
        return None
    steering = grid.signals["steering"]
    v = np.interp(steering.time, *speed)
    angle = steering.value[:, 0] - grid.facts.get("steering.zero", 0.0)
    way = grid.put("steering", integrated(steering.time, (v * angle)[:, None]))[:, 0]
    return grid.facts["steering.gain"] * way


def leaned(grid: Grid) -> Float[np.ndarray, " T"] | None:
    """Yaw of a vehicle on wheels by its side acceleration: integral of a_right / v."""
    speed = _speed(grid)
    if "accelerometer" not in grid or "gyro" not in grid or "attitude" in grid or speed is None:
        return None
    if not grid.facts.get("forward", 1.0):
        return None
    acc = grid.signals["accelerometer"]
    v = np.interp(acc.time, *speed)
    rate = np.where(v > MOVING_M_S, acc.value[:, 1] / np.maximum(v, MOVING_M_S), 0.0)
    return grid.put("accelerometer", integrated(acc.time, rate[:, None]))[:, 0]
