"""Is the error of each range too large? Logistic regression on the features of anfis-cubature."""

from collections.abc import Sequence

from sensorfault.core.monitor import Branch
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.needs import follower
from sensorfault.methods.ranging.range_filter import (
    GROWTH,
    WRONG,
    Filter,
    cubature,
    fitted,
    followed,
    model,
    monitor,
    on_ranges,
)
from sensorfault.methods.ranging.ranges_learned import learned, lessons, widest
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.logistic_regression import LogisticRegression
from sensorfault.training.labelled import Labelled
from sensorfault.training.logistic import fit_logistic
from sensorfault.training.session import Session
from sensorfault.vehicles.underwater import FollowerRoles


def logistic(name: str, log: Log, found: FollowerRoles, filter: Filter, labelled: Sequence[Labelled]) -> Model:
    """The model with odds learned from these ranges, one regression for each leader."""
    wrong_m = WRONG * filter.sigma_m
    models = tuple(fit_logistic(features, size > wrong_m) for features, size in labelled)
    test = LogisticRegression(models, widest(labelled), tuple(leader.range for leader in found.leaders))
    calibrated = monitor(log, cubature(log, found, filter), Branch(test, on_ranges(log, found, 0.0)))
    return model(name, log, found, calibrated, ("log odds",), filter, {"wrong_m": wrong_m})


def _build(log: Log, seed: int, session: Session) -> Model:
    found = followed(RECIPE.name, log)
    session.progress("fitting the noise of ranges and dead reckoning")
    own = fitted(log, found, Filter(growth=GROWTH))
    session.progress("fitting the regression")
    return logistic(RECIPE.name, log, found, own, learned(log, found, own, lessons(log, found, own, seed)))


RECIPE = Recipe(
    name="logistic-cubature",
    title="Logistic regression on innovation, Mahalanobis distance and R* of an adaptive cubature filter",
    source="the features of Xu et al. 2023, (28)-(31), without fuzzy rules",
    false_alarm_rate="not designed",
    build=_build,
    needs=follower,
)
