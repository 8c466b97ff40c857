"""How often the channels of a log are measured."""

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Log

MISSED = 3.0  # a sensor is silent after this many of its periods without a measurement


def hold_s(log: Log) -> Float[np.ndarray, " C"]:
    """How long each channel's value and verdict stay valid without a new measurement [s].

    One and a half periods for a sensor slower than the log's rate, 0 for one that is measured in every row.
    """
    period = {sensor.name: sensor.period_s for sensor in log.sensors}
    own = np.array([period[channel.sensor] for channel in log.channels])
    return np.where(own > 1.5 * log.period_s, 1.5 * own, 0.0)


def complete(log: Log, watched: Bool[np.ndarray, " C"]) -> Bool[np.ndarray, " T"]:
    """Rows in which every watched channel has a new value."""
    rows = np.ones(len(log), bool)
    for i in np.flatnonzero(watched):  # much faster than along the short axis
        rows &= log.arrived[:, i]
    return rows
