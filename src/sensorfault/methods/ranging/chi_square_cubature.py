"""Does each range agree with dead reckoning and the other leaders? χ² test of the innovation, at 0.05 and 0.01."""

from functools import partial
from statistics import NormalDist

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log
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
from sensorfault.training.session import Session
from sensorfault.vehicles.underwater import FollowerRoles


def limit(far: float) -> float:
    """√χ²(1 - far) with one degree of freedom; `far`: false alarm rate."""
    return NormalDist().inv_cdf(1 - far / 2)


def gate(log: Log, found: FollowerRoles, residual: Cubature, far: float) -> Monitor:
    """The filter with the test."""
    return monitor(log, residual, Branch(Normalised(), on_ranges(log, found, limit(far))))


def chi_square(name: str, log: Log, far: float, filter: Filter | None = None, adaptive: bool = False) -> Model:
    """Fit the noises on a healthy log, unless the filter is given.

    Raises:
        LogError: the log is not that of a follower.
    """
    found = followed(name, log)
    own = filter or fitted(log, found, Filter(adaptive=adaptive, growth=GROWTH))
    calibrated = gate(log, found, cubature(log, found, own), far)
    return model(name, log, found, calibrated, ("chi-square",), own, {"false_alarms": far})


def _build(name: str, far: float, adaptive: bool, log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting the noise of ranges and dead reckoning")
    return chi_square(name, log, far, adaptive=adaptive)


RECIPES = (
    Recipe(
        name="chi-square-ckf-05",
        title="Cubature Kalman filter of a follower; χ² of each range's innovation",
        source="Xu et al. 2023, (1)-(20), the test compared there",
        false_alarm_rate="0.05 of the healthy ranges, if the noise is Gaussian and as large as the filter assumes",
        build=partial(_build, "chi-square-ckf-05", 0.05, False),
        needs=follower,
    ),
    Recipe(
        name="chi-square-ckf-01",
        title="Cubature Kalman filter of a follower; χ² of each range's innovation",
        source="Xu et al. 2023, (1)-(20), the test compared there",
        false_alarm_rate="0.01 of the healthy ranges, if the noise is Gaussian and as large as the filter assumes",
        build=partial(_build, "chi-square-ckf-01", 0.01, False),
        needs=follower,
    ),
    Recipe(
        name="chi-square-ackf-05",
        title="Adaptive cubature Kalman filter of a follower; χ² of each range's innovation",
        source="Xu et al. 2023, (1)-(20), (30), (31), the test compared there",
        false_alarm_rate="0.05 of the healthy ranges, if the noise is Gaussian and as large as the filter assumes",
        build=partial(_build, "chi-square-ackf-05", 0.05, True),
        needs=follower,
    ),
    Recipe(
        name="chi-square-ackf-01",
        title="Adaptive cubature Kalman filter of a follower; χ² of each range's innovation",
        source="Xu et al. 2023, (1)-(20), (30), (31), the test compared there",
        false_alarm_rate="0.01 of the healthy ranges, if the noise is Gaussian and as large as the filter assumes",
        build=partial(_build, "chi-square-ackf-01", 0.01, True),
        needs=follower,
    ),
)
