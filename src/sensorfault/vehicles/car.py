"""A car: the channels of its motion, and the kinematic bicycle model."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Channel, Log
from sensorfault.logs.units import si_unit

LEAST_SPEED = 2.0  # below this the course is unreliable [m/s]


@dataclass(frozen=True)
class Roles:
    """Columns of a log that describe a car's motion; None where the log has no such channel.

    Velocity over ground is `north` and `east`, or `speed` and `course` (clockwise from north). `gyro` and
    `accelerometer` are the columns of x, y and z. `steering` is the angle of the steering wheel or of the front wheels.
    """

    latitude: int | None = None
    longitude: int | None = None
    speed: int | None = None
    course: int | None = None
    north: int | None = None
    east: int | None = None
    steering: int | None = None
    gyro: tuple[int, int, int] | None = None
    accelerometer: tuple[int, int, int] | None = None

    @property
    def position(self) -> tuple[int, int] | None:
        """Columns of latitude and longitude."""
        return None if self.latitude is None or self.longitude is None else (self.latitude, self.longitude)

    @property
    def velocity(self) -> tuple[int, int] | None:
        """Columns of the velocity over ground: north and east, else speed and course."""
        if self.north is not None and self.east is not None:
            return self.north, self.east
        return None if self.speed is None or self.course is None else (self.speed, self.course)

    @property
    def polar(self) -> bool:
        """Whether `velocity` is speed and course."""
        return self.north is None or self.east is None

    def lacking(self, *names: str) -> str:
        """The names of these roles that are missing; empty if none is."""
        return ", ".join(name for name in names if getattr(self, name) is None)


def roles(log: Log) -> Roles:
    """The first channel with each name and unit in the log's order; channels of the receiver come first.

    Course and speed of two sensors would be no velocity, because they are new at different times.
    """
    found: dict[str, int] = {}
    for name, unit in _NAMES.items():
        all_of = [i for i, c in enumerate(log.channels) if _called(c, name) and si_unit(c.unit) == unit]
        receiver = log.channels[found["latitude"]].sensor if "latitude" in found else None
        own = [i for i in all_of if log.channels[i].sensor == receiver]
        if all_of:
            found[name] = (own or all_of)[0]
    return Roles(**found, gyro=axes(log.channels, "rad/s"), accelerometer=axes(log.channels, "m/s^2"))


_NAMES = {
    "latitude": "rad",
    "longitude": "rad",
    "speed": "m/s",
    "course": "rad",
    "north": "m/s",
    "east": "m/s",
    "steering": "rad",
}
_ALSO = {"steering": ("steering_angle", "angle")}


def _called(channel: Channel, name: str) -> bool:
    return channel.name in (name, *_ALSO.get(name, ()))


def axes(channels: tuple[Channel, ...], unit: str) -> tuple[int, int, int] | None:
    """Columns of x, y and z of the first sensor that has all three in this unit."""
    for sensor in dict.fromkeys(channel.sensor for channel in channels):
        at = {c.name: i for i, c in enumerate(channels) if c.sensor == sensor and si_unit(c.unit) == unit}
        if {"x", "y", "z"} <= at.keys():
            return at["x"], at["y"], at["z"]
    return None


def moving(log: Log, found: Roles, speed: float = LEAST_SPEED) -> Float[np.ndarray, " N"]:
    """Times of new velocities above `speed` [s]; empty for a car that never moves."""
    if found.velocity is None:
        return np.zeros(0)
    first, second = (log.value[:, i] for i in found.velocity)
    size = np.abs(first) if found.polar else np.hypot(first, second)
    times: Float[np.ndarray, " N"] = log.time[log.fresh[:, found.velocity[0]] & (size > speed)]
    return times
