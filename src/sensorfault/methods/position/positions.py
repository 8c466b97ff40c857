"""The positions of a healthy drive, and the columns that a predictor uses."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Log, LogError
from sensorfault.training.inputs import Inputs
from sensorfault.vehicles.car import Roles, roles

GAP = 5.5  # ticks without a row that break a window
LEAST_FIXES = 50
LEAST_DISTANCE = 1e-6  # a drive that stays within this angle never moved [rad], about 6 m


@dataclass(frozen=True)
class Positions:
    """A healthy log with the columns that a predictor of the position uses."""

    log: Log
    roles: Roles
    columns: tuple[int, int]  # latitude, longitude
    half: Float[np.ndarray, "2"]  # half of their training range [rad]
    turning: tuple[int, ...]  # columns that are angles which wrap around

    @classmethod
    def of(cls, name: str, log: Log) -> "Positions":
        """For the method called `name`.

        Raises:
            LogError: no positions, too few positions, or a car that never moves.
        """
        found = roles(log)
        if found.position is None:
            raise LogError(
                f"{log.name} has no {found.lacking('latitude', 'longitude')}, which {name} predicts; "
                "name the columns in vehicle.toml, or take another method."
            )
        latitude, longitude = found.position
        new = log.fresh[:, found.position].all(axis=1) & np.isfinite(log.value[:, found.position]).all(axis=1)
        if new.sum() < LEAST_FIXES:
            raise LogError(f"{log.name} has {new.sum()} positions, but {name} needs {LEAST_FIXES}; give it more data.")
        inputs = Inputs.of(log, found.position, 2, (longitude,))
        if inputs.half.max() < LEAST_DISTANCE / 2:
            raise LogError(f"{log.name} never moves, so {name} has nothing to predict; give a drive that moves.")
        return cls(log, found, (latitude, longitude), inputs.half, (longitude,))

    @property
    def stale_s(self) -> Float[np.ndarray, " C"]:
        """After a silence longer than this, the last value of a channel is no longer used [s]."""
        period = {sensor.name: sensor.period_s for sensor in self.log.sensors}
        own = np.array([period[channel.sensor] for channel in self.log.channels])
        return np.maximum(MISSED * own, GAP * self.log.period_s) + self.log.period_s / 2

    @property
    def inputs(self) -> tuple[int, ...]:
        """V = (lat, lon, ω, a): the input columns of a network, as far as the log has them."""
        return (*self.columns, *(self.roles.gyro or ()), *(self.roles.accelerometer or ()))

    def mark(self, columns: tuple[int, ...]) -> Bool[np.ndarray, " C"]:
        """True for these columns."""
        marked: Bool[np.ndarray, " C"] = np.isin(np.arange(len(self.log.channels)), columns)
        return marked
