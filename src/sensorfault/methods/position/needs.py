"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

import numpy as np

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position.positions import Positions
from sensorfault.numerics.geodesy import FARTHEST
from sensorfault.training.bicycle_data import check_bicycle
from sensorfault.training.mounting import check_mounting
from sensorfault.vehicles.arm import joints
from sensorfault.vehicles.car import LEAST_SPEED, Roles, moving, roles

LEAST_MOVING_S = 20.0


def joints_or_position(name: str, log: Log) -> Positions | None:
    """The positions; None if the log has joints.

    Raises:
        LogError: neither, too few positions, or a car that never moves.
    """
    found = joints(log)
    return None if found.rates or found.angles else Positions.of(name, log)


def positions_and_inertial(name: str, log: Log) -> tuple[Positions, tuple[int, ...]]:
    """The positions, and the columns of the inertial unit.

    Raises:
        LogError: no usable positions, or neither inertial unit nor velocity.
    """
    positions = Positions.of(name, log)
    found = positions.roles
    inertial = (*(found.gyro or ()), *(found.accelerometer or ()))
    if not inertial and found.velocity is None:
        raise LogError(
            f"{log.name} has neither gyro, accelerometer nor velocity, from which {name} estimates the displacement; "
            "name the columns in vehicle.toml, or take another method."
        )
    return positions, inertial


def position_and_velocity(name: str, log: Log) -> Roles:
    """The columns to compare.

    Raises:
        LogError: a column is missing, the drive is at a pole, or the car hardly moves.
    """
    found = roles(log)
    if found.position is None or found.velocity is None:
        lacks = "position (latitude and longitude)" if found.position is None else "velocity over ground"
        raise LogError(
            f"{log.name} has no {lacks}; {name} compares the two: name the columns in vehicle.toml, or take a method "
            "that needs only the inertial unit."
        )
    latitude = log.value[:, found.position[0]]
    if not (np.abs(latitude[np.isfinite(latitude)]) <= FARTHEST).any():
        raise LogError(f"{log.name} lies within 0.1 degrees of a pole, where east has no meaning; take another method.")
    moves = moving(log, found)
    seconds = len(moves) * float(np.median(np.diff(moves))) if len(moves) > 2 else 0.0
    if seconds < LEAST_MOVING_S:
        raise LogError(
            f"{log.name} moves for {seconds:.0f} s, but {name} needs {LEAST_MOVING_S:g} s above {LEAST_SPEED:g} m/s to "
            "learn what is healthy; give a drive that moves."
        )
    return found


def inertial_and_velocity(name: str, log: Log) -> None:
    """Whether the log shows how the inertial unit is mounted.

    Raises:
        LogError: no inertial unit or velocity, or a car that never moves, turns or changes its speed.
    """
    check_mounting(log, roles(log))


def bicycle(name: str, log: Log) -> None:
    """Whether the log shows the motion of a car.

    Raises:
        LogError: a channel is missing, or the car hardly moves.
    """
    check_bicycle(log, roles(log))
