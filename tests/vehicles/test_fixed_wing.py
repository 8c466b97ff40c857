"""Which column of a log says what of an aircraft's height."""

from dataclasses import replace

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.vehicles.fixed_wing import Roles, roles


def log(*paths: tuple[str, str, str]) -> Log:
    channels = tuple(Channel(name, sensor, unit) for sensor, name, unit in paths)
    sensors = tuple(Sensor(name, 0.1) for name in dict.fromkeys(c.sensor for c in channels))
    value = np.ones((4, len(channels)))
    return Log(np.arange(4.0), value, np.ones(value.shape, bool), channels, sensors)


def test_who_says_how_high_it_flies() -> None:
    found = roles(
        log(
            ("barometer", "altitude", "m"),
            ("ins", "down", "m/s"),
            ("gnss", "altitude", "mm"),
            ("gnss", "down", "m/s"),
            ("control", "elevator", ""),
            ("control", "throttle", "%"),
            ("attitude", "pitch", "deg"),
            ("airspeed", "airspeed", "m/s"),
            *(("accelerometer", axis, "m/s^2") for axis in "xyz"),
        )
    )
    assert found == Roles(2, 0, 3, -1.0, 1, -1.0, 6, None, 4, 5, 7, (8, 9, 10))
    assert found.inputs == (6, 5, 4)
    assert found.unit == ()
    assert replace(found, roll=11).unit == (6, 11, 8, 9, 10)


def test_a_height_of_nobody_known_is_the_receivers() -> None:
    found = roles(log(("baro", "height", "m"), ("state", "height", "m"), ("state", "climb", "m/s")))
    assert (found.height, found.barometric, found.vertical, found.upward) == (1, 0, 2, 1.0)
    alone = roles(log(("barometer", "altitude", "m"), ("state", "pitch", "m")))
    assert alone == Roles(barometric=0)


def test_an_autopilots_estimate_is_neither_receiver_nor_inertial_unit() -> None:
    """Names as `init` makes them for a folder of PX4's topics."""
    found = roles(
        log(
            ("tecs_height", "altitude", "m"),
            ("global_position_gnss", "latitude", "deg"),
            ("global_position_gnss", "down", "m/s"),
            ("global_position_height", "altitude", "m"),
            ("gps_position_gnss", "latitude", "deg"),
            ("gps_position_gnss", "down", "m/s"),
            ("gps_position_height", "altitude", "m"),
            ("local_position", "down", "m/s"),
        )
    )
    assert (found.height, found.vertical, found.inertial) == (6, 5, None)


def test_the_receiver_is_who_tells_a_latitude() -> None:
    found = roles(log(("estimate", "height", "m"), ("nav", "latitude", "deg"), ("nav", "height", "m")))
    assert found.height == 2
