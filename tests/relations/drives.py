"""A small copter and a small car of the tests' own: smooth motion, known noise, every sensor consistent with it."""

from dataclasses import replace

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor

G = 9.80665
EARTH_M = 6_371_000.0


def table(name: str, period_s: float, columns: dict[str, tuple[dict[str, np.ndarray], float, str]]) -> Log:
    """A log of sensors: name -> (channels, its period [s], unit); each is new at every multiple of its period."""
    channels, sensors, values, marks = [], [], [], []
    for sensor, (numbers, own_s, unit) in columns.items():
        every = round(own_s / period_s)
        sensors.append(Sensor(sensor, own_s))
        for channel, value in numbers.items():
            fresh = np.arange(len(value)) % every == 0
            channels.append(Channel(channel, sensor, unit, watch=channel not in ("latitude", "longitude", "altitude")))
            values.append(np.where(fresh, value, np.nan))
            marks.append(fresh)
    rows = len(values[0])
    time = period_s * np.arange(rows)
    return Log(time, np.stack(values, 1), np.stack(marks, 1), tuple(channels), tuple(sensors), name)


def copter(seconds: float = 240.0, seed: int = 0) -> Log:
    """Hops, turns and leans of a copter: inertial unit 50 Hz, attitude, barometer and compass 10 Hz, GNSS 5 Hz."""
    rng = np.random.default_rng(seed)
    step = 0.02
    t = step * np.arange(round(seconds / step))
    wave = [rng.uniform(0.01, 0.04, 3) * 2 * np.pi for _ in range(4)]
    turn = [rng.uniform(0, 2 * np.pi, 3) for _ in range(4)]

    def smooth(i: int, size: float) -> np.ndarray:
        return size * sum(np.sin(w * t + p) for w, p in zip(wave[i], turn[i], strict=True)) / 3

    north, east, up, yaw = smooth(0, 60.0), smooth(1, 60.0), 30 + smooth(2, 12.0), smooth(3, 3.0)
    velocity = np.stack([np.gradient(x, step) for x in (north, east, up)])
    force = np.stack([np.gradient(v, step) for v in velocity])  # north, east, up
    roll, pitch = 0.1 * np.sin(0.7 * t), 0.1 * np.cos(0.5 * t)
    body = _to_body(roll, pitch, yaw, np.stack([force[0], force[1], -force[2] - G]))
    dr, dp, dy = (np.gradient(x, step) for x in (roll, pitch, yaw))
    rate = np.stack(
        [
            dr - dy * np.sin(pitch),
            dp * np.cos(roll) + dy * np.cos(pitch) * np.sin(roll),
            -dp * np.sin(roll) + dy * np.cos(pitch) * np.cos(roll),
        ]
    )
    field = _to_body(roll, pitch, yaw, np.stack([0.2 + 0 * t, 0 * t, 0.4 + 0 * t]))

    def noisy(x: np.ndarray, sigma: float) -> np.ndarray:
        return x + rng.normal(0, sigma, np.shape(x))

    place = {
        "latitude": 0.6 + noisy(north, 0.02) / EARTH_M,
        "longitude": 0.2 + noisy(east, 0.02) / EARTH_M / np.cos(0.6),
        "altitude": noisy(up, 0.1),
        "north": noisy(velocity[0], 0.05),
        "east": noisy(velocity[1], 0.05),
        "down": -noisy(velocity[2], 0.05),
    }
    return table(
        "copter",
        step,
        {
            "gyro": (dict(zip("xyz", noisy(rate, 0.005), strict=True)), 0.02, "rad/s"),
            "accelerometer": (dict(zip("xyz", noisy(body, 0.05), strict=True)), 0.02, "m/s^2"),
            "attitude": ({"roll": noisy(roll, 1e-3), "pitch": noisy(pitch, 1e-3), "yaw": noisy(yaw, 1e-3)}, 0.1, "rad"),
            "barometer": ({"altitude": noisy(up, 0.1)}, 0.1, "m"),
            "magnetometer": (dict(zip("xyz", noisy(field, 0.002), strict=True)), 0.1, "gauss"),
            "gnss": (place, 0.2, ""),
        },
    )


def car(seconds: float = 300.0, seed: int = 0) -> Log:
    """A car with gyro and accelerometer 20 Hz, wheels and steering 20 Hz, GNSS 5 Hz."""
    rng = np.random.default_rng(seed)
    step = 0.05
    t = step * np.arange(round(seconds / step))
    phase = rng.uniform(0, 2 * np.pi, 6)
    speed = 12 + 4 * np.sin(0.11 * t + phase[0]) + 2 * np.sin(0.31 * t + phase[1])
    rate = 0.12 * np.sin(0.13 * t + phase[2]) * np.maximum(np.sin(0.05 * t + phase[3]), 0) + 0.05 * np.maximum(
        np.sin(0.21 * t + phase[4]) - 0.5, 0
    )
    course = np.cumsum(rate) * step
    north, east = np.cumsum(speed * np.cos(course)) * step, np.cumsum(speed * np.sin(course)) * step

    def noisy(x: np.ndarray, sigma: float) -> np.ndarray:
        return x + rng.normal(0, sigma, np.shape(x))

    turns = np.stack([0 * t, 0 * t, rate])
    force = np.stack([np.gradient(speed, step), speed * rate, -G + 0 * t])
    place = {
        "latitude": 0.9 + noisy(north, 0.2) / EARTH_M,
        "longitude": 0.2 + noisy(east, 0.2) / EARTH_M / np.cos(0.9),
        "speed": noisy(speed, 0.05),
        "course": noisy(course, 0.005),
    }
    return table(
        "car",
        step,
        {
            "gyro": (dict(zip("xyz", noisy(turns, 0.003), strict=True)), 0.05, "rad/s"),
            "accelerometer": (dict(zip("xyz", noisy(force, 0.05), strict=True)), 0.05, "m/s^2"),
            "wheels": ({"speed": noisy(speed, 0.02)}, 0.05, "m/s"),
            "steering": ({"angle": noisy(rate * 2.7 / speed * 15, 0.002)}, 0.05, "rad"),
            "gnss": (place, 0.2, ""),
        },
    )


def _to_body(roll: np.ndarray, pitch: np.ndarray, yaw: np.ndarray, local: np.ndarray) -> np.ndarray:
    """North, east, down to forward, right, down: rotations one after the other, by their own small matrices."""
    out = np.empty_like(local)
    for i, (r, p, y) in enumerate(zip(roll, pitch, yaw, strict=True)):
        about_down = np.array([[np.cos(y), np.sin(y), 0], [-np.sin(y), np.cos(y), 0], [0, 0, 1]])
        about_right = np.array([[np.cos(p), 0, -np.sin(p)], [0, 1, 0], [np.sin(p), 0, np.cos(p)]])
        about_forward = np.array([[1, 0, 0], [0, np.cos(r), np.sin(r)], [0, -np.sin(r), np.cos(r)]])
        out[:, i] = about_forward @ about_right @ about_down @ local[:, i]
    return out


def changed(log: Log, path: str, start_s: float, end_s: float, how: object) -> Log:
    """The log with `how(time, value)` in place of a channel's values from start to end."""
    column = log.index(path)
    rows = (log.time >= start_s) & (log.time < end_s)
    value = log.value.copy()
    value[rows, column] = how(log.time[rows], value[rows, column])  # type: ignore[operator]
    return replace(log, value=value, fresh=log.fresh & np.isfinite(value))


def mounted(log: Log, turn: np.ndarray, gravity: float = 1.0) -> Log:
    """The same drive with its inertial unit mounted otherwise."""
    value = log.value.copy()
    for sensor in ("gyro", "accelerometer", "magnetometer"):
        if sensor in {one.name for one in log.sensors}:
            columns = list(log.of(sensor))
            value[:, columns] = value[:, columns] @ turn.T * (gravity if sensor == "accelerometer" else 1.0)
    return replace(log, value=value)
