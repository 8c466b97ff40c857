"""Roll, pitch and yaw from the quaternion of an autopilot."""

from dataclasses import replace

import numpy as np
import polars as pl

from sensorfault.logs.readers.source import Source

# w, x, y, z, from body to the world: PX4's to north-east-down, ROS's to east-north-up
_QUATERNIONS = (
    tuple(f"q[{i}]" for i in range(4)),
    *(tuple(f"{at}orientation.{part}" for part in "wxyz") for at in ("", "pose.", "pose.pose.")),
)
ANGLES = ("roll_of_quaternion [rad]", "pitch_of_quaternion [rad]", "yaw_of_quaternion [rad]")


def with_attitude(source: Source) -> Source:
    """The same file with the angles of its quaternion as further columns, if it has one."""
    frame = source.frame
    numbers = {name for name, dtype in frame.schema.items() if dtype.is_numeric()}
    names = next((names for names in _QUATERNIONS if numbers.issuperset(names)), None)
    if names is None:
        return source
    w, x, y, z = (frame[name].cast(pl.Float64).to_numpy() for name in names)
    # roll = atan2(2(wx + yz), 1 - 2(x² + y²)), pitch = asin 2(wy - zx), yaw = atan2(2(wz + xy), 1 - 2(y² + z²))
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    angles = [pl.Series(name, angle) for name, angle in zip(ANGLES, (roll, pitch, yaw), strict=True)]
    return replace(source, frame=frame.with_columns(angles))
