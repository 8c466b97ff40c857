"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

from sensorfault.logs.table import Log, LogError
from sensorfault.vehicles.follower_columns import FollowerColumns, follower_columns

LEAST = 40  # ranges needed of each leader


def follower(name: str, log: Log) -> FollowerColumns:
    """The columns of a follower in this log.

    Raises:
        LogError: no leader, no initial position, or too few ranges.
    """
    found = follower_columns(log)
    if not found.leaders:
        raise LogError(
            f"{log.name} has no sensor with a range [m] and a position, but {name} needs one for each leader; name the "
            "columns in vehicle.toml, or take another method."
        )
    if not found.position or not log.fresh[:, list(found.position)].all(axis=1).any():
        raise LogError(
            f"{log.name} has no position of the vehicle itself, but {name} starts from one; give a log with a fix."
        )
    few = min(int(log.fresh[:, leader.range].sum()) for leader in found.leaders)
    if few < LEAST:
        raise LogError(f"{log.name} has a leader with {few} ranges, but {name} needs {LEAST}; give a longer log.")
    return found
