"""Fuzzy rules estimate the error of each range from its innovation in an adaptive cubature filter."""

from collections.abc import Sequence
from functools import partial

import numpy as np

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
from sensorfault.stages.statistic.fuzzy_inference import FuzzyInference
from sensorfault.training.fuzzy import Setting, fit_anfis
from sensorfault.training.labelled import Labelled
from sensorfault.training.session import Session
from sensorfault.vehicles.underwater import FollowerRoles

RULES = Setting()


def anfis(
    name: str,
    log: Log,
    found: FollowerRoles,
    filter: Filter,
    labelled: Sequence[Labelled],
    rmse: bool,
    setting: Setting = RULES,
) -> Model:
    """The model with one set of rules for each leader. `rmse`: the limit is T2, 3 RMSE of the training, else T1."""
    fits = [fit_anfis(*of_leader, setting) for of_leader in labelled]
    limits = np.array([3 * fit.rmse for fit in fits]) if rmse else np.full(len(fits), WRONG * filter.sigma_m)
    columns = tuple(leader.range for leader in found.leaders)
    test = FuzzyInference(tuple(fit.model for fit in fits), widest(labelled), columns)
    calibrated = monitor(log, cubature(log, found, filter), Branch(test, on_ranges(log, found, limits)))
    summary = {"rmse_m": [fit.rmse for fit in fits], "limits_m": limits.tolist()}
    return model(name, log, found, calibrated, ("predicted error",), filter, summary)


def _build(name: str, rmse: bool, log: Log, seed: int, session: Session) -> Model:
    found = followed(name, log)
    session.progress("fitting the noise of ranges and dead reckoning")
    own = fitted(log, found, Filter(growth=GROWTH))
    session.progress("learning rules")
    return anfis(name, log, found, own, learned(log, found, own, lessons(log, found, own, seed)), rmse)


RECIPES = (
    Recipe(
        name="anfis-cubature",
        title="ANFIS on innovation, Mahalanobis distance and R* of an adaptive cubature filter; limit: 3 times the "
        "RMSE of the training",
        source="Xu et al. 2023, (1)-(35)",
        false_alarm_rate="not designed",
        build=partial(_build, "anfis-cubature", True),
        needs=follower,
    ),
    Recipe(
        name="anfis-cubature-9m",
        title="ANFIS on innovation, Mahalanobis distance and R* of an adaptive cubature filter; limit: 3 standard "
        "deviations of a range, 9 m for 3 m",
        source="Xu et al. 2023 with limit T1 in place of T2",
        false_alarm_rate="not designed",
        build=partial(_build, "anfis-cubature-9m", False),
        needs=follower,
    ),
)
