"""The height of a healthy flight, and the roles of the other columns."""

from dataclasses import dataclass

import numpy as np

from sensorfault.logs.table import Log, LogError
from sensorfault.training.fixes import Fixes
from sensorfault.vehicles.fixed_wing import Roles, roles


@dataclass(frozen=True)
class Heights:
    """A healthy log, the column of the height to observe, and the roles of the other columns."""

    log: Log
    column: int
    roles: Roles

    @classmethod
    def of(cls, name: str, log: Log) -> "Heights":
        """The receiver's height, or the barometer's height if there is no other.

        Raises:
            LogError: no height.
        """
        found = roles(log)
        column = found.height if found.height is not None else found.barometric
        if column is None:
            raise LogError(
                f"{log.name} has no altitude or height in metres, which {name} observes; name the columns in "
                "vehicle.toml, or take another method."
            )
        return cls(log, column, found)

    def fixes(self, columns: tuple[int, ...], start_s: float = -np.inf, end_s: float = np.inf) -> Fixes:
        """New heights in a part of the log, with these inputs."""
        return Fixes.of(self.log.between(start_s, end_s), self.column, columns)
