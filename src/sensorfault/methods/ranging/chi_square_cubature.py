"""Does each range agree with dead reckoning and the other leaders? χ² test of the innovation, at 0.05 and 0.01."""

from functools import partial
from statistics import NormalDist

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log
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


def _recipe(far: float, adaptive: bool) -> Recipe:
    name = f"chi-square-{'ackf' if adaptive else 'ckf'}-{f'{far:.2f}'[2:]}"

    def build(log: Log, seed: int, session: Session) -> Model:
        session.progress("fitting the noise of ranges and dead reckoning")
        return chi_square(name, log, far, adaptive=adaptive)

    return Recipe(
        name=name,
        title=f"{'Adaptive c' if adaptive else 'C'}ubature Kalman filter of a follower; χ² of each range's innovation",
        source="Xu et al. 2023, (1)-(20)" + (", (30), (31)" if adaptive else "") + ", the test compared there",
        false_alarm_rate=f"{far:g} of the healthy ranges, if the noise is Gaussian and as large as the filter assumes",
        build=build,
        needs=partial(followed, name),
    )


RECIPES = tuple(_recipe(far, adaptive) for adaptive in (False, True) for far in (0.05, 0.01))
