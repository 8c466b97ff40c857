"""Which column of a log says what of a car."""

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.vehicles.car import Roles, moving, roles


def log(*paths: tuple[str, str, str]) -> Log:
    channels = tuple(Channel(name, sensor, unit) for sensor, name, unit in paths)
    sensors = tuple(Sensor(name, 0.1) for name in dict.fromkeys(c.sensor for c in channels))
    value = np.ones((4, len(channels)))
    return Log(np.arange(4.0), value, np.ones(value.shape, bool), channels, sensors)


RECEIVER = (
    *(("gnss", "latitude", "deg"), ("gnss", "longitude", "deg"), ("gnss", "speed", "km/h"), ("gnss", "course", "deg")),
)


def test_the_receiver_speaks_of_itself_before_the_wheels() -> None:
    found = roles(log(("can", "speed", "m/s"), *RECEIVER))
    assert (found.latitude, found.longitude, found.speed, found.course) == (1, 2, 3, 4)
    assert found.velocity == (3, 4)
    assert found.polar


def test_velocity_in_components_and_a_speed_from_elsewhere() -> None:
    parts = (
        ("gnss", "latitude", "deg"),
        ("gnss", "longitude", "deg"),
        ("gnss", "north", "m/s"),
        ("gnss", "east", "m/s"),
    )
    found = roles(log(("can", "speed", "m/s"), *parts))
    assert found.speed == 0
    assert found.velocity == (3, 4)
    assert not found.polar


def test_names_of_other_units_are_something_else() -> None:
    found = roles(log(("map", "latitude", "m"), ("imu", "x", "rad/s"), ("imu", "y", "rad/s")))
    assert found == Roles()
    assert found.lacking("latitude", "gyro") == "latitude, gyro"


def test_both_halves_of_an_inertial_unit() -> None:
    axes = [("imu", axis, "rad/s") for axis in "xyz"] + [("force", axis, "g") for axis in "zyx"]
    found = roles(log(*axes))
    assert found.gyro == (0, 1, 2)
    assert found.accelerometer == (5, 4, 3)


def test_a_drive_that_never_moves_has_no_moving_times() -> None:
    still = log(*RECEIVER)
    assert len(moving(still, roles(still))) == 0
    assert len(moving(still, roles(still), speed=0.5)) == 4
    assert len(moving(log(("imu", "x", "rad/s")), Roles())) == 0
