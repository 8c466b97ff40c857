"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.rates import complete
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.rows import Training
from sensorfault.vehicles.arm import Joints, joints

LEAST_ROWS = 20
OFTEN = 0.9  # share of the ticks with a value; a channel that is often late breaks the runs of consecutive rows


def often(name: str, log: Log) -> Training:
    """The rows with every watched channel; watched are channels with a value in nearly every tick.

    Raises:
        LogError: too few complete rows, or no channel to watch.
    """
    return Training.of(name, log, OFTEN)


def two_joints(name: str, log: Log) -> tuple[Joints, Bool[np.ndarray, " C"], Bool[np.ndarray, " T"]]:
    """The joints, the watched columns, and the rows that have all of them.

    Raises:
        LogError: not exactly two joints, or too few rows.
    """
    found = joints(log)
    for what, columns in (("rate", found.rates), ("angle", found.angles), ("torque", found.torques)):
        if len(columns) != 2:
            raise LogError(
                f"{log.name} has {len(columns)} channels called {what} in SI units, but {name} needs one for each of "
                "two joints; name the columns in vehicle.toml, or take another method."
            )
    watched = np.isin(np.arange(len(log.channels)), (*found.rates, *found.angles))
    rows = complete(log, watched)
    if rows.sum() < LEAST_ROWS:
        raise LogError(
            f"{log.name} has {rows.sum()} rows with every rate and angle, but {name} needs {LEAST_ROWS}; give more."
        )
    return found, watched, rows
