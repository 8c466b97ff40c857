"""Which of a follower's leaders sends wrong ranges? The recommended recipe."""

import numpy as np
from jaxtyping import Float

from sensorfault.calibration.limits import repeat_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.chi_square_cubature import limit
from sensorfault.methods.ranging.needs import follower
from sensorfault.methods.ranging.range_filter import (
    GROWTH,
    Filter,
    cubature,
    fitted,
    followed,
    model,
    monitor,
    on_ranges,
)
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.residual.cubature import Cubature
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.training.session import Session
from sensorfault.vehicles.underwater import FollowerRoles

FALSE_ALARMS = 0.01  # of the healthy ranges
LEAST_RUN = 5.0  # a shorter run of repeats is never called frozen
REPEATED = 1e6  # factor on R for an exact repeat: the filter ignores it


def cooperative(name: str, log: Log, filter: Filter | None = None) -> Model:
    """Fit the noises on a healthy log, unless the filter is given.

    Raises:
        LogError: the log is not that of a follower.
    """
    found = followed(name, log)
    own = filter or fitted(log, found, Filter(growth=GROWTH, repeated=REPEATED))
    calibrated, longest = gates(log, found, cubature(log, found, own))
    summary = {"false_alarms": FALSE_ALARMS, "repeats": longest.tolist()}
    return model(name, log, found, calibrated, ("chi-square", "repeats"), own, summary)


def gates(log: Log, found: FollowerRoles, residual: Cubature) -> tuple[Monitor, Float[np.ndarray, " L"]]:
    """The filter with both tests, and the longest allowed run of repeats of each leader, from this healthy log."""
    repeats = Repeats(len(log.channels))
    runs = open_loop_scores(monitor(log, residual, Branch(repeats, on_ranges(log, found, np.inf))), log)[0]
    columns = [leader.range for leader in found.leaders]
    longest = np.maximum(repeat_limit(runs, log.period_s)[columns], LEAST_RUN)
    calibrated = monitor(
        log,
        residual,
        Branch(Normalised(), on_ranges(log, found, limit(FALSE_ALARMS))),
        Branch(repeats, on_ranges(log, found, longest), certain=True),
    )
    return calibrated, longest


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting the noise of ranges and dead reckoning")
    return cooperative(RECIPE.name, log)


RECIPE = Recipe(
    name="cooperative",
    title="Adaptive cubature filter of a follower that ignores exactly repeated ranges; χ² of each range, and exact "
    "repeats",
    source="Xu et al. 2023, (1)-(20), (30), (31), with noise fitted to the log and without the rules, which do not "
    "help",
    false_alarm_rate="0.01 of the healthy ranges, if the noise is Gaussian",
    build=_build,
    needs=follower,
)
