"""The signals of a log by role: what each sensor measures, at its own times, in SI units and one convention each."""

import re
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import SAID, Channel, Log
from sensorfault.relations.constellation import solved

SATELLITES = "satellites"  # all that a receiver receives, as one device
RANGE_ROLE = "range of a satellite"
EARTH_M = 6_371_000.0  # mean radius
ABSURD = 1e8  # no sensor measures so much of anything in SI units: such a number is no measurement
XYZ = ("x", "y", "z")


@dataclass(frozen=True)
class Signal:
    """One quantity of one sensor at its own n times.

    `role`: what it is ("gnss.height"). `key`: unique name, the role with the number of the device if it is not the
    first ("gnss2.height"). `sensor`: the log's name of the device. `columns`: its channels in the log. `value`: SI, and
    local metres (north, east) for positions. `zero`: what these are metres from, as the log has it.
    """

    key: str
    role: str
    sensor: str
    columns: tuple[int, ...]
    time: Float[np.ndarray, " n"]
    value: Float[np.ndarray, "n k"]
    zero: tuple[float, ...] = ()

    @cached_property
    def period_s(self) -> float:
        """The usual time between two measurements [s]."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else float("inf")

    def cut(self, start_s: float, end_s: float) -> "Signal":
        """What was measured from start to end, both included."""
        rows = slice(int(np.searchsorted(self.time, start_s)), int(np.searchsorted(self.time, end_s, side="right")))
        return replace(self, time=self.time[rows], value=self.value[rows])


# An autopilot's estimates are no witnesses: they follow the sensors that they are made of.
_ESTIMATE = re.compile(
    r"global_position|local_position|estimat|ekf|filtered|setpoint|odom|nav_?(lat|lon|alt|v)|ref|truth|gt_|ground_?truth|relative|"
    r"uncalibrated"  # nor is a device with a zero and axes of its own
)
_BEGIN, BEGINS_S = re.compile(r"gnss|heading|attitude"), 10.0  # these repeat a value until they know where they are
REPEATS, REPEATS_S = 8, 3.0
LEAST_FORCE = 2.0  # [m/s^2]: what is usually less holds no gravity
_INERTIAL = frozenset({"gyro", "accelerometer", "yaw_rate"})
SELDOM_S = 0.25  # an inertial sensor with longer steps was logged as samples, between which anything may happen
_BAROMETER = re.compile(r"(?<!differential_)(?<!raw_)(?<!filtered_)baro|pressure_height|air_data|static")
_WHEEL = re.compile(r"wheel|odo")
_COMPASS = re.compile(r"compass|magnet|hdt|heading")
_SPEED_UNITS = {"m/s", "km/h", "mph", "kn"}
_RATE_UNITS, _FIELD_UNITS = ("rad/s", "deg/s", "mrad/s"), ("gauss", "mgauss", "uT", "T", "nT")


def signals_of(log: Log) -> dict[str, Signal]:
    """All signals of a log whose role is known, by key."""
    found: dict[str, Signal] = {}
    for sensor in log.sensors:
        if _ESTIMATE.search(sensor.name.lower()) and not _of_wheels(log, sensor.name):
            continue
        columns = {log.channels[i].name: i for i in log.of(sensor.name) if log.channels[i].kind not in SAID}
        for role, names in _roles(sensor.name.lower(), columns, log.channels):
            _add(found, log, sensor.name, role, tuple(columns[name] for name in names))
    if not any(key.startswith("gnss") for key in found):
        found.update(_of_satellites(log))
    return _speed_of_whom(found)


def _of_wheels(log: Log, sensor: str) -> bool:
    """Whether an "odometry" is no more than a speed: that of the wheels, not what an estimator makes of it."""
    units = {log.channels[i].unit for i in log.of(sensor)}
    return _WHEEL.search(sensor.lower()) is not None and units <= _SPEED_UNITS


def _of_satellites(log: Log) -> dict[str, Signal]:
    """A receiver made of raw satellites, and by how much the range of each is off."""
    sky = solved(log)
    if sky is None:
        return {}
    parts = {
        "gnss.position": _convention("gnss.position", (), sky.degrees, _zero("gnss.position", (), sky.degrees)),
        "gnss.height": sky.height[:, None],
        "gnss.velocity": sky.velocity[:, :2],
        "gnss.climb": sky.velocity[:, 2:],
        **{f"{name}.range": sky.off[:, i, None] for i, name in enumerate(sky.names)},
    }
    found = {}
    for key, value in parts.items():
        there = np.isfinite(value).all(axis=1)
        device = key.partition(".")[0]
        role, sensor = (key, SATELLITES) if device == "gnss" else (RANGE_ROLE, device)
        if there.sum() >= 5:
            found[key] = Signal(key, role, sensor, (), sky.time[there], value[there])
    return found


def _speed_of_whom(found: dict[str, Signal]) -> dict[str, Signal]:
    """A speed of no named device is the wheels' where there is a steering, else the receiver's."""
    if "speed" not in found:
        return found
    speed = found.pop("speed")
    key = "wheel" if "steering" in found or "gnss.position" not in found else "gnss.speed"
    if key not in found and "wheel" not in found:
        found[key] = replace(speed, key=key, role=key)
    return found


def _roles(sensor: str, columns: dict[str, int], channels: tuple[Channel, ...]) -> list[tuple[str, tuple[str, ...]]]:
    """The roles that a sensor's channels have, with the channels of each."""
    unit = {name: channels[i].unit for name, i in columns.items()}
    roles: list[tuple[str, tuple[str, ...]]] = []

    def role(name: str, *wanted: str) -> bool:
        there = all(one in columns for one in wanted)
        if there:
            roles.append((name, wanted))
        return there

    beacon = {"latitude", "range"} <= set(columns)
    if beacon:
        return []
    gnss = "latitude" in columns or re.search(r"gnss|gps", sensor) is not None
    if set(XYZ) <= set(columns):
        if unit["x"] in _RATE_UNITS and "gyro" in sensor:
            role("gyro", *XYZ)
        elif unit["x"] in _FIELD_UNITS:
            role("magnetometer", *XYZ)
        elif "accel" in sensor:
            role("accelerometer", *XYZ)
        elif "dvl" in sensor:
            role("dvl", "x", "y")
    if "gyro" in sensor and "z" in columns and "x" not in columns:
        role("yaw_rate", "z")
    role("dvl", "forward", "right")
    if not role("attitude", "roll", "pitch", "yaw"):
        role("attitude", "roll", "pitch")
    role("gnss.position", "latitude", "longitude")
    if gnss:
        role("gnss.height", "altitude") or role("gnss.height", "height")
        role("gnss.velocity", "north", "east")
        role("gnss.climb", "down") or role("gnss.climb", "up") or role("gnss.climb", "z")
        role("gnss.speed", "speed")
        role("gnss.course", "course")
    elif _BAROMETER.search(sensor):
        role("barometer", "altitude") or role("barometer", "height") or role("barometer", "pressure")
    elif "depth" in columns and "range" not in columns:
        role("depth", "depth")
    elif _WHEEL.search(sensor) or "wheel_speed" in columns:
        wheels = tuple(name for name in columns if unit[name] in _SPEED_UNITS)
        if wheels:
            roles.append(("wheel", wheels))
    elif sensor == "speed":
        role("speed", "speed")
    if not gnss and "yaw" not in columns:
        role("heading", "heading") or (_COMPASS.search(sensor) and role("heading", "course"))
    if "airspeed" in sensor or any("airspeed" in name for name in columns):
        names = [name for name in columns if "airspeed" in name and "filtered" not in name and "deriv" not in name]
        if names:
            roles.append(("airspeed", (next((n for n in names if n.startswith("true")), names[0]),)))
    if "steer" in sensor:
        role("steering", "angle")
    return roles


def _add(found: dict[str, Signal], log: Log, sensor: str, role: str, columns: tuple[int, ...]) -> None:
    mine = list(columns)
    new = _measured(log, sensor, role, columns)
    if new.sum() < 5:
        return
    if role in _INERTIAL and np.median(np.diff(log.time[new])) > SELDOM_S:
        return
    value = log.value[np.flatnonzero(new)[:, None], mine]
    if role == "barometer" and log.channels[mine[0]].name == "pressure" and not 2e4 < np.median(value) < 1.2e5:
        return  # a differential pressure, not that of the air
    names = tuple(log.channels[i].name for i in mine)
    zero = _zero(role, names, value)
    value = _convention(role, names, value, zero)
    if role == "accelerometer" and _without_gravity(value):
        return
    time = log.time[new]
    if _BEGIN.match(role):
        begun = _begun(time, value)
        time, value = time[begun:], value[begun:]
    base, _, rest = role.partition(".")
    number = 1
    while (key := f"{base}{'' if number == 1 else number}{'.' + rest if rest else ''}") in found:
        number += 1
    same = next((s.key for s in found.values() if s.sensor == sensor and s.role.partition(".")[0] == base), None)
    if rest and same is not None:
        key = f"{same.partition('.')[0]}.{rest}"
    found.setdefault(key, Signal(key, role, sensor, columns, time, value, zero))


def gone_on(signal: Signal, log: Log) -> Signal:
    """What the same device measured in later rows, in the same convention."""
    new = _measured(log, signal.sensor, signal.role, signal.columns)
    value = log.value[np.flatnonzero(new)[:, None], list(signal.columns)]
    names = tuple(log.channels[i].name for i in signal.columns)
    return replace(signal, time=log.time[new], value=_convention(signal.role, names, value, signal.zero))


def _measured(log: Log, sensor: str, role: str, columns: tuple[int, ...]) -> Bool[np.ndarray, " T"]:
    """Rows in which a device measured something."""
    mine = list(columns)
    new = log.fresh[:, mine].any(axis=1) & (np.abs(log.value[:, mine]) < ABSURD).all(axis=1)
    return np.asarray(new & _has_fix(log, sensor) if role.startswith("gnss.") else new)


def _without_gravity(value: Float[np.ndarray, "n k"]) -> bool:
    """Whether gravity was taken off an accelerometer: then it shows no vertical. One that is dead is kept."""
    length = np.linalg.norm(value, axis=1)
    return bool(np.median(length) < LEAST_FORCE and np.median(np.abs(np.diff(length))) > 0)


def _begun(time: Float[np.ndarray, " n"], value: Float[np.ndarray, "n k"]) -> int:
    """The row from which on a receiver or a filter knows where it is: until then it repeats one of its first values."""
    changes = np.flatnonzero((np.diff(value, axis=0) != 0).any(axis=1))
    ends = np.r_[changes, len(time) - 1]
    starts = np.r_[0, changes + 1]
    early = time[starts] - time[0] < BEGINS_S
    held = early & (ends - starts >= REPEATS) & (time[ends] - time[starts] > REPEATS_S) & (ends < len(time) - 1)
    return int(ends[held][-1]) + 1 if held.any() else 0


def _has_fix(log: Log, sensor: str) -> Bool[np.ndarray, " T"]:
    """Rows in which the receiver is not at 0 degrees north and east, which means that it has no fix yet."""
    place = [i for i in log.of(sensor) if log.channels[i].name in ("latitude", "longitude")]
    return np.asarray((log.value[:, place] != 0).any(axis=1)) if place else np.ones(len(log), bool)


def _zero(role: str, names: tuple[str, ...], value: Float[np.ndarray, "n k"]) -> tuple[float, ...]:
    """The usual place of a receiver, the first pressure of a barometer."""
    if role == "gnss.position":
        return float(np.median(value[:, 0])), float(np.median(value[:, 1]))
    return (float(np.median(value[:5])),) if role == "barometer" and names[0] == "pressure" else ()


def _convention(
    role: str, names: tuple[str, ...], value: Float[np.ndarray, "n k"], zero: tuple[float, ...]
) -> Float[np.ndarray, "n _"]:
    """Local metres for degrees, up for down, altitude for pressure, one speed for several wheels."""
    if role == "gnss.position":
        latitude, longitude = value.T
        around = np.angle(np.exp(1j * (longitude - zero[1])))
        return np.stack([EARTH_M * (latitude - zero[0]), EARTH_M * np.cos(zero[0]) * around], axis=1)
    if role == "gnss.climb" and names[0] in ("down", "z"):
        return -value
    if role == "depth":
        return -value
    if role == "barometer" and names[0] == "pressure":
        # international standard atmosphere: h = 44330 (1 - (p / p0)^0.1903), p0 the first pressure
        return np.asarray(44_330.0 * (1 - np.maximum(value / zero[0], 1e-3) ** 0.190263))
    if role == "wheel" and value.shape[1] > 1:
        return np.asarray(value.mean(axis=1, keepdims=True))
    return value
