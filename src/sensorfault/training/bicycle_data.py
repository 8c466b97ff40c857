"""What a healthy drive must have for the fit of the bicycle filter."""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError
from sensorfault.vehicles.car import Roles, moving

LEAST_MOVING_S = 20.0


def check_bicycle(log: Log, found: Roles) -> None:
    """Check that the log has the channels and the motion that the fit needs.

    Raises:
        LogError: a channel is missing, or the car hardly moves.
    """
    steered = found.steering is not None
    lacking = [
        words
        for missing, words in (
            (found.position is None, "latitude and longitude"),
            (found.speed is None and (found.north is None or found.east is None), "speed"),
            (found.gyro is None and not steered, "gyro with x, y, z, nor a steering angle"),
        )
        if missing
    ]
    if lacking:
        raise LogError(
            f"{log.name} has no {lacking[0]}, which the bicycle model needs; name the columns in vehicle.toml."
        )
    times = moving(log, found) if found.velocity else _fast(log, found)
    seconds = len(times) * float(np.median(np.diff(times))) if len(times) > 2 else 0.0
    if seconds < LEAST_MOVING_S:
        raise LogError(
            f"{log.name} moves faster than 2 m/s for {seconds:.0f} s, but the bicycle model needs {LEAST_MOVING_S:g} "
            "s; give a drive that moves."
        )


def _fast(log: Log, found: Roles) -> Float[np.ndarray, " N"]:
    assert found.speed is not None
    times: Float[np.ndarray, " N"] = log.time[log.fresh[:, found.speed] & (np.abs(log.value[:, found.speed]) > 2.0)]
    return times
