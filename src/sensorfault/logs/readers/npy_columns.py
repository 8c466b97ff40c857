"""What the columns of an array are called. An array has no header, so that only its name can tell."""

_AXES = ("x", "y", "z")
_WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
_FIX = ("latitude [deg]", "longitude [deg]", "speed [m/s]", "utc_timestamp", "altitude [m]", "course [deg]")


def _axes(name: str, unit: str) -> tuple[str, ...]:
    return tuple(f"{name}_{axis} [{unit}]" for axis in _AXES)


# As comma2k19 documents its arrays (commaai/comma2k19, README, "Log Format" and "Pose Format"). Axes: forward, right,
# down; of positions and velocities earth-centred (ECEF). Its `bearing` is the course over ground. It says tesla of the
# magnetometer; the numbers are microtesla.
_DOCUMENTED: dict[str, tuple[str, ...]] = {
    "accelerometer": _axes("accelerometer", "m/s^2"),
    "acceleration": _axes("acceleration", "m/s^2"),
    "gyro": _axes("gyro", "rad/s"),
    "gyro_uncalibrated": _axes("gyro_uncalibrated", "rad/s"),
    "gyro_bias": _axes("gyro_bias", "rad/s"),
    "magnetometer": _axes("magnetometer", "uT"),
    "magnetometer_uncalibrated": _axes("magnetometer_uncalibrated", "uT"),
    "speed": ("speed [m/s]",),
    "car_speed": ("speed [m/s]",),
    "wheel_speed": tuple(f"wheel_speed_{wheel} [m/s]" for wheel in _WHEELS),
    "wheel_speeds": tuple(f"wheel_speed_{wheel} [m/s]" for wheel in _WHEELS),
    "steering_angle": ("steering_angle [deg]",),
    "live_gnss_qcom": _FIX,
    "live_gnss_ublox": _FIX,
    "positions": _axes("position", "m"),
    "velocities": _axes("velocity", "m/s"),
    "orientations": tuple(f"orientation_{part}" for part in "wxyz"),
    "gps_times": ("gps_week", "gps_time_of_week"),
}


def columns_of(name: str, width: int | None, alone: bool = True) -> tuple[str, ...]:
    """Names of an array's columns.

    Args:
        name: what the array measures, the last part of its file's name.
        width: its number of columns; None for an array of one axis.
        alone: whether it is the only array of its table; the columns of several tell their arrays apart.
    """
    known = _DOCUMENTED.get(name, ())
    if len(known) == (width or 1):
        return known
    if width is None:
        return (name,)
    return tuple(f"c{i + 1}" if alone else f"{name}_c{i + 1}" for i in range(width))
