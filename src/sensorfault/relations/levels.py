"""What must be so at every moment: gravity at rest, no spike, no impossible speed, no exact repeat while moving.

A change detector and its slow mean hide exactly these. Each finding accuses one device by itself.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.relations.grid import GRAVITY, Grid
from sensorfault.relations.signals import Signal

REST_ACC, REST_RATE, REST_RATE_SD = 0.25, 0.08, 0.03  # at rest: sd of |a|, mean and sd of |rate| over 1 s
RESTING = 8  # measurements in a second that can show rest
REST_OFF, REST_WINDOWS = 0.6, 3  # gravity at rest may be off by this [m/s^2], median of three windows
FLIGHT_OFF, TILT_RAD = 2.0, 1.05  # mean acceleration over 2 s may differ from g by this, unless the vehicle leans
GYRO_REST = 0.3  # a gyro at rest may read this [rad/s]; less is a matter of calibration
ROUGH_RATE, ROUGH_ACC = 0.7, 2.5  # rougher than this [rad/s, m/s^2] gravity is not to be seen
SPIKE_M = {"copter": 30.0, "wing": 40.0, "car": 30.0}
CLIMB_M_S = {"copter": 35.0, "wing": 60.0, "car": 15.0}
SPEED_M_S = {"copter": 45.0, "wing": 80.0, "car": 70.0, "underwater": 10.0}
RISE_M_S = {"copter": 25.0, "wing": 40.0, "car": 12.0, "underwater": 5.0}
SILENT_S, SILENT_PERIODS = 3.5, 5.0
REPEATS, REPEAT_TURN_RAD, REPEAT_S = 8, 1.0, 3.0
AIR_SCALE = (0.7, 1.4)
STEER_ZERO_RAD = np.radians(1.5)


LASTING = ("length of gravity at rest", "length of gravity over 2 s", "rate at rest")


@dataclass(frozen=True)
class Finding:
    """One device is wrong from `start_s` to `end_s`; `value` beyond `limit`, as `test` says."""

    device: str
    start_s: float
    end_s: float
    test: str
    value: float
    limit: float
    kind: str = "unknown"
    lasting: bool = False  # nothing is compared with the device from then on


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """All findings in a piece."""
    for key, signal in grid.signals.items():
        base = signal.role
        if base == "accelerometer":
            yield from _gravity(grid, signal, vehicle)
        elif base == "gyro":
            yield from _rate_at_rest(grid, signal)
        elif base == "barometer":
            yield from _height(signal, vehicle, "barometer")
        elif base == "gnss.height":
            yield from _height(signal, vehicle, "height")
        elif base in ("gnss.velocity", "gnss.speed"):
            yield from _beyond(
                signal,
                np.linalg.norm(signal.value, axis=1),
                SPEED_M_S.get(vehicle, 100.0),
                "speed that no such vehicle has",
            )
        elif base == "gnss.climb":
            yield from _beyond(
                signal, np.abs(signal.value[:, 0]), RISE_M_S.get(vehicle, 60.0), "climb rate that no such vehicle has"
            )
        if base != "attitude" and not key.startswith("attitude"):
            yield from _repeats(grid, signal)
    yield from _steering(grid)
    yield from _airspeed(grid)


def device_of(signal: Signal) -> str:
    """The device that is accused for a signal."""
    return signal.key.partition(".")[0]


def _windows(
    time: Float[np.ndarray, " n"], value: Float[np.ndarray, " n"], width: float, least: int = 3
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centre, mean and standard deviation over windows beside each other that have enough measurements."""
    if not len(time):
        return np.zeros(0), np.zeros(0), np.zeros(0)
    bin_of = ((time - time[0]) / width).astype(int)
    count = np.bincount(bin_of)
    many = count >= least
    total, square, at = (np.bincount(bin_of, x)[many] / count[many] for x in (value, value * value, time))
    return at, total, np.sqrt(np.maximum(square - total * total, 0.0))


def _at_rest(grid: Grid, acc: Signal) -> tuple[np.ndarray, np.ndarray]:
    """Windows of 1 s at rest by the inertial unit: centre, and mean length of the acceleration."""
    if "gyro" not in grid:
        return np.zeros(0), np.zeros(0)
    at, mean, sd = _windows(acc.time, np.linalg.norm(acc.value, axis=1), 1.0, RESTING)
    gyro = grid.signals["gyro"]
    when, rate, rate_sd = _windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 1.0, RESTING)
    if not len(at) or not len(when):
        return np.zeros(0), np.zeros(0)
    still = (sd < REST_ACC) & (np.interp(at, when, rate) < REST_RATE) & (np.interp(at, when, rate_sd) < REST_RATE_SD)
    return at[still], mean[still]


def _runs(time: Float[np.ndarray, " n"], bad: Bool[np.ndarray, " n"], join_s: float) -> Iterator[tuple[int, int]]:
    """First and last index of each run of bad ones, joined over short breaks."""
    index = np.flatnonzero(bad)
    if not len(index):
        return
    cut = np.flatnonzero(np.diff(time[index]) > join_s)
    yield from zip(index[np.r_[0, cut + 1]].tolist(), index[np.r_[cut, len(index) - 1]].tolist(), strict=True)


def _worst(
    device: str, time: np.ndarray, value: np.ndarray, limit: float, join_s: float, test: str, half_s: float = 0.0
) -> Iterator[Finding]:
    """One finding for each run of values beyond a limit."""
    for first, last in _runs(time, np.abs(value) > limit, join_s):
        peak = value[first : last + 1][np.argmax(np.abs(value[first : last + 1]))]
        start_s, end_s = float(time[first]) - half_s, float(time[last]) + half_s
        yield Finding(device, start_s, end_s, test, float(peak), limit, lasting=test in LASTING)


def _gravity(grid: Grid, acc: Signal, vehicle: str) -> Iterator[Finding]:
    device = device_of(acc)
    at, length = _at_rest(grid, acc)
    if len(at) >= REST_WINDOWS:
        off = _median_of_last(length - GRAVITY, REST_WINDOWS)
        yield from _worst(device, at, off, REST_OFF, 1e9, "length of gravity at rest", 0.5)
    if vehicle == "wing" or acc.period_s > 0.5:
        return
    means = [_windows(acc.time, acc.value[:, i], 2.0) for i in range(3)]
    at = means[0][0]
    if len(at) < 5:
        return
    off = _median_around(np.sqrt(sum(mean**2 for _, mean, _ in means)) - GRAVITY, 2)
    rough = np.max([spread for _, _, spread in means], axis=0) > ROUGH_ACC
    if "gyro" in grid:
        gyro = grid.signals["gyro"]
        when, rate, _ = _windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 2.0)
        rough |= np.interp(at, when, rate) > ROUGH_RATE if len(when) else False
    off = np.where(_median_around(rough.astype(float), 2) > 0, 0.0, off)
    if "attitude" in grid:
        attitude = grid.signals["attitude"]
        lean = [np.interp(at, attitude.time, np.abs(attitude.value[:, i])) for i in (0, 1)]
        off = np.where(np.maximum(*lean) > TILT_RAD, 0.0, off)
    yield from _worst(device, at, off, FLIGHT_OFF, 10.0, "length of gravity over 2 s", 1.0)


def _median_of_last(x: np.ndarray, count: int) -> np.ndarray:
    return np.array([np.median(x[max(0, i - count + 1) : i + 1]) if i >= count - 1 else 0.0 for i in range(len(x))])


def _median_around(x: np.ndarray, half: int) -> np.ndarray:
    return np.array([np.median(x[max(0, i - half) : i + half + 1]) for i in range(len(x))])


def _rate_at_rest(grid: Grid, gyro: Signal) -> Iterator[Finding]:
    number = gyro.key.removeprefix("gyro")
    if f"accelerometer{number}" not in grid:
        return
    acc = grid.signals[f"accelerometer{number}"]
    at, _, sd = _windows(acc.time, np.linalg.norm(acc.value, axis=1), 1.0, RESTING)
    when, rate, rate_sd = _windows(gyro.time, np.linalg.norm(gyro.value, axis=1), 1.0, RESTING)
    if len(at) < 2 or len(when) < 5:
        return
    still = (np.interp(when, at, sd) < 0.05) & (rate_sd < REST_RATE_SD)
    rate = np.where(still, rate, 0.0)
    yield from _worst("gyro" + number, when, _median_around(rate, 2), GYRO_REST, 10.0, "rate at rest", 0.5)


def _height(signal: Signal, vehicle: str, what: str) -> Iterator[Finding]:
    device, h, time = device_of(signal), signal.value[:, 0], signal.time
    if len(h) < 6:
        return
    back, ahead = h[1:-1] - h[:-2], h[1:-1] - h[2:]
    close = (np.diff(time)[:-1] < 2.5) & (np.diff(time)[1:] < 2.5)
    spike = np.where((back * ahead > 0) & close, np.minimum(np.abs(back), np.abs(ahead)), 0.0)
    limit = SPIKE_M.get(vehicle, 40.0)
    for i in np.flatnonzero(spike > limit):
        yield Finding(
            device,
            float(time[i + 1]),
            float(time[i + 1]),
            f"one sample of {what} alone",
            float(spike[i]),
            limit,
            "spike",
        )
    if what == "barometer":
        at, mean, _ = _windows(time, h, 1.0)
        if len(at) > 2:
            rate = np.abs(np.diff(mean)) / np.diff(at) * (np.diff(at) < 1.6)
            lone = np.interp(at[1:], time[1:-1], spike) > limit  # a spike moves the mean of its second
            wide = np.array([((time[1:-1] > t - 2.1) & (time[1:-1] < t + 1.1) & (spike > limit)).any() for t in at[1:]])
            yield from _worst(
                device,
                at[1:],
                np.where(lone | wide, 0.0, rate),
                CLIMB_M_S.get(vehicle, 60.0),
                60.0,
                "climb rate that no such vehicle has",
                1.0,
            )


def _beyond(signal: Signal, value: np.ndarray, limit: float, test: str) -> Iterator[Finding]:
    yield from _worst(device_of(signal), signal.time, value, limit, 5.0, test)


def _repeats(grid: Grid, signal: Signal) -> Iterator[Finding]:
    """Exact repeats of a sensor that else does not repeat, or while the vehicle turns."""
    value, time = signal.value, signal.time
    if len(value) < 20 or not np.ptp(value, axis=0).any() or signal.role.startswith("gnss.course"):
        return
    same = np.r_[False, (np.diff(value, axis=0) == 0).all(axis=1)]
    lively = same.mean() < 0.5
    runs = [(first, last) for first, last in _runs(np.arange(len(time), dtype=float), same, 1.0)]
    if not runs:
        return
    turned = _turned(grid, time)
    moved = _moved(grid, time, signal)
    lengths = sorted((last - first + 1 for first, last in runs), reverse=True)
    usual = lengths[1] if len(lengths) > 1 else 1
    for first, last in runs:
        count, lasts = last - first + 1, float(time[last] - time[first - 1])
        turning = turned is not None and turned[last] - turned[first - 1] > REPEAT_TURN_RAD
        moving = moved is not None and moved[last] - moved[first - 1] > max(20.0, 5.0 * lasts / 5.0)
        noisy = lively and count > 10 * usual and count >= 2 * REPEATS
        rest_too = signal.role in (
            "gnss.position",
            "gnss.height",
            "gnss.speed",
            "gnss.velocity",
            "gnss.climb",
            "wheel",
            "depth",
            "steering",
            "dvl",
            "barometer",
            "airspeed",
        )
        if count < REPEATS or lasts < REPEAT_S:
            continue
        if (
            (turning and not rest_too)
            or (moving and signal.role in ("gnss.position", "gnss.velocity", "dvl", "heading"))
            or (noisy and not (rest_too and float(np.abs(value[first]).max()) < 1e-9))
        ):
            yield Finding(
                device_of(signal), float(time[first - 1]), float(time[last]), "exact repeats", lasts, REPEAT_S, "frozen"
            )


def _turned(grid: Grid, time: np.ndarray) -> np.ndarray | None:
    """How far the gyro has turned in all [rad]."""
    if "gyro" not in grid:
        return None
    gyro = grid.signals["gyro"]
    step = np.minimum(np.diff(gyro.time, prepend=gyro.time[0]), 0.5)
    return np.interp(time, gyro.time, np.cumsum(np.linalg.norm(gyro.value, axis=1) * step))


def _moved(grid: Grid, time: np.ndarray, signal: Signal) -> np.ndarray | None:
    """How far the vehicle went, by another device [m]."""
    for key in ("wheel", "dvl", "gnss.speed", "gnss.velocity"):
        if key in grid and key != signal.key:
            other = grid.signals[key]
            step = np.minimum(np.diff(other.time, prepend=other.time[0]), 2.0)
            return np.interp(time, other.time, np.cumsum(np.linalg.norm(other.value, axis=1) * step))
    return None


def _steering(grid: Grid) -> Iterator[Finding]:
    """The steering's angle on straights, where the gyro shows no turn."""
    speed = next((key for key in ("wheel", "gnss.speed") if key in grid), None)
    if "steering" not in grid or "gyro" not in grid or speed is None:
        return
    rate = np.gradient(grid.integral("gyro")[:, 2], grid.time)
    straight = (np.abs(rate) < 0.02) & (grid.value(speed)[:, 0] > 5.0)
    angle = grid.value("steering")[:, 0][straight]
    if (
        len(angle) >= 40
        and abs(np.median(angle)) > STEER_ZERO_RAD
        and np.median(np.abs(angle - np.median(angle))) < np.radians(1.0)
    ):
        yield Finding(
            "steering",
            grid.start_s,
            grid.end_s,
            "angle on straights",
            float(np.median(angle)),
            STEER_ZERO_RAD,
            "offset",
        )


def _airspeed(grid: Grid) -> Iterator[Finding]:
    """Airspeed over ground speed, over a minute and all headings."""
    speed = next((key for key in ("gnss.speed", "gnss.velocity") if key in grid), None)
    if "airspeed" not in grid or speed is None:
        return
    ground = np.linalg.norm(grid.value(speed), axis=1)
    air = grid.value("airspeed")[:, 0]
    there = np.isfinite(ground) & np.isfinite(air)
    if (ground[there] > 4.0).sum() < 300:
        return
    ratio = float(np.median(air[there & (ground > 4.0)]) / np.median(ground[there & (ground > 4.0)]))
    if not AIR_SCALE[0] < ratio < AIR_SCALE[1]:
        yield Finding(
            "airspeed",
            grid.start_s,
            grid.end_s,
            "airspeed over ground speed",
            ratio,
            AIR_SCALE[0] if ratio < 1 else AIR_SCALE[1],
            "scale",
            lasting=True,
        )


def silences(signals: dict[str, Signal], pieces: list[tuple[float, float]], vehicle: str) -> Iterator[Finding]:
    """Devices without a valid measurement while the others go on; not before their first one.

    A receiver under water has nothing to receive.
    """
    for device in dict.fromkeys(device_of(signal) for signal in signals.values()):
        if vehicle == "underwater" and device.startswith("gnss"):
            continue
        mine = [signal for signal in signals.values() if device_of(signal) == device]
        limit = max(SILENT_S, SILENT_PERIODS * min(signal.period_s for signal in mine))
        time = np.unique(np.concatenate([signal.time for signal in mine]))
        for start, end in pieces:
            inside = time[(time >= start) & (time <= end)]
            begun = time[0] < start
            stops = np.r_[start if begun else np.zeros(0), inside, end] if len(inside) or begun else np.zeros(0)
            for i in np.flatnonzero(np.diff(stops) > limit):
                yield Finding(
                    device,
                    float(stops[i]),
                    float(stops[i + 1]),
                    "silence",
                    float(stops[i + 1] - stops[i]),
                    limit,
                    "missing",
                )
