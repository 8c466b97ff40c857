"""The rows of a healthy log that a multivariate method is fitted on."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.rates import complete
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.watch import watchable

LEAST_ROWS = 50


@dataclass(frozen=True)
class Training:
    """A healthy log, its watched channels, and the rows that have all of them.

    `reasons`: path of each channel that is not watched -> why.
    """

    log: Log
    watched: Bool[np.ndarray, " C"]
    rows: Bool[np.ndarray, " T"]
    reasons: dict[str, str]

    @classmethod
    def of(cls, name: str, log: Log, often: float = 0.5) -> "Training":
        """For the method called `name`; watched are channels with a value in at least the share `often` of the ticks.

        Raises:
            LogError: too few complete rows, or no channel to watch.
        """
        watched, reasons = watchable(log, often)
        rows = complete(log, watched)
        if rows.sum() < LEAST_ROWS:
            raise LogError(
                f"{log.name} has {rows.sum()} rows with every watched channel, {name} needs {LEAST_ROWS}; "
                "give it more data, or watch fewer channels."
            )
        return cls(log, watched, rows, reasons)
