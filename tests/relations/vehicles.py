"""The vehicles on which the laws of the default method are tried: a healthy log of each, and its lies."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

import sensorfault as sf
from relations import drives
from sensorfault.logs.table import Log
from sensorfault.runtime.compared import Comparison
from sensorfault.simulation import arm, flapping_wing, train, underwater

METRE = 1 / 6_371_000.0  # [rad] of latitude
FIT_S = 400.0


@dataclass(frozen=True, eq=False)
class Vehicle:
    """A kind of vehicle on a log that its model has not seen.

    Args:
        make: a log of so many seconds with that seed.
        duration_s: of the log.
        lie_s: from when to when a sensor lies or is silent [s].
        lies: what is added to a channel of each sensor that others can contradict [SI].
        alone: the same for channels that no other sensor contradicts enough to tell who lies.
        alike: sensors that are one device to the method, by the name that it gives them.
    """

    name: str
    make: Callable[[float, int], Log]
    duration_s: float
    lie_s: tuple[float, float]
    lies: dict[str, float]
    alone: dict[str, float] = field(default_factory=dict)
    alike: str = ""

    @cached_property
    def log(self) -> Log:
        return self.make(self.duration_s, 3)

    @cached_property
    def model(self) -> Comparison:
        fitted = sf.fit(self.make(FIT_S, 1))
        assert isinstance(fitted, Comparison)
        return fitted

    def lied(self, path: str, size: float) -> Log:
        """The log with a channel that is off by `size` from start to end."""
        return drives.changed(self.log, path, *self.lie_s, lambda time, x: x + size)

    @property
    def rows(self) -> np.ndarray:
        """The rows of the lie."""
        return (self.log.time >= self.lie_s[0]) & (self.log.time < self.lie_s[1])

    def __str__(self) -> str:
        return self.name


CAR = Vehicle(
    "car",
    drives.car,
    150.0,
    (40.0, 65.0),
    {"gyro.z": 0.3, "accelerometer.x": 3.0, "wheels.speed": 6.0, "steering.angle": 1.0, "gnss.latitude": 40 * METRE},
    {"gyro.x": 2.0, "accelerometer.z": 1.0},
)
COPTER = Vehicle(
    "copter",
    drives.copter,
    150.0,
    (40.0, 65.0),
    {
        "gyro.z": 0.5,
        "accelerometer.z": 3.0,
        "attitude.yaw": 1.0,
        "barometer.altitude": 15.0,
        "magnetometer.x": 0.6,
        "gnss.altitude": 15.0,
        "gnss.north": 5.0,
    },
    {"attitude.roll": 0.6, "attitude.pitch": -0.3},
)
WING = Vehicle(
    "wing",
    lambda seconds, seed: flapping_wing.fly(seconds, seed, beat_hz=0.0, imu_hz=25.0).log,
    150.0,
    (40.0, 65.0),
    {
        "gyro.z": 0.5,
        "accelerometer.z": 8.0,
        "attitude.yaw": 1.5,
        "barometer.altitude": 25.0,
        "gnss.longitude": 80 * METRE,
        "airspeed.airspeed": 8.0,
    },
    {"control.throttle": 2.0, "attitude.roll": 0.15, "attitude.pitch": 0.3},
)
RAIL = Vehicle(
    "rail",
    lambda seconds, seed: train.ride(seconds, seed, "gaussian", imu_hz=20).log,
    240.0,
    (100.0, 140.0),
    {"gyro.z": 0.1, "accelerometer.x": 2.0, "G32.corrected_m": 80.0},
    alike="satellites",
)
UNDERWATER = Vehicle(
    "underwater",
    lambda seconds, seed: underwater.sail(seconds, seed, surface_s=seconds).log,
    300.0,
    (100.0, 140.0),
    {"gps.latitude": 60 * METRE, "dvl.forward": 2.0, "compass.heading": 1.0},
    {"pressure.depth": 2.0, "leader1.range": 20.0},
)
VEHICLES = (CAR, COPTER, WING, RAIL, UNDERWATER)


def joints(samples: int = 15_000) -> Log:
    """A two-joint arm: its sensors have no partner in any relation."""
    return arm.run(seed=3, samples=samples)
