"""Simulated drives that several cases share."""

import functools

from sensorfault.logs.table import Log
from sensorfault.simulation import road

POSITION = ["gnss.latitude", "gnss.longitude"]
IMU = [f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz"]
CAR = [*IMU, *POSITION, "gnss.speed", "gnss.course"]
UNDER_WAY = 262.0, 282.0  # [s] of a drive of 300 s: at 7 to 13 m/s


@functools.cache
def drive(duration_s: float) -> Log:
    return road.drive(duration_s, seed=3).log
