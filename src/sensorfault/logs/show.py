"""What a log is called in one line."""

from collections.abc import Sequence
from typing import Protocol

from sensorfault.logs.phrase import listed


class Named(Protocol):
    """Something with a name."""

    @property
    def name(self) -> str: ...


class Measured(Named, Protocol):
    """Something with a name and a unit."""

    @property
    def unit(self) -> str: ...


def sensor_words(sensors: Sequence[Named]) -> str:
    """`sensors gyro, gnss`: the names, of many the first."""
    names = [sensor.name for sensor in sensors]
    return f"{'sensor' if len(names) == 1 else 'sensors'} {listed(names) or 'none'}"


def channel_words(channel: Measured) -> str:
    """`x [deg/s]`."""
    return f"{channel.name} [{channel.unit}]" if channel.unit else channel.name
