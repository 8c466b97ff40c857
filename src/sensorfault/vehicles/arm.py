"""A robot arm: the channels of its joints, and the motion of two joints in a vertical plane."""

from dataclasses import dataclass

from sensorfault.logs.table import Log
from sensorfault.logs.units import si_unit


@dataclass(frozen=True)
class Joints:
    """Columns of the rates, angles and torques of an arm's joints, in the log's order."""

    rates: tuple[int, ...]
    angles: tuple[int, ...]
    torques: tuple[int, ...]


def joints(log: Log) -> Joints:
    """Channels called `rate`, `angle` and `torque`, at most one of each for a joint."""

    def called(name: str, unit: str) -> tuple[int, ...]:
        return tuple(i for i, c in enumerate(log.channels) if c.name == name and si_unit(c.unit) == unit)

    return Joints(called("rate", "rad/s"), called("angle", "rad"), called("torque", "Nm"))
