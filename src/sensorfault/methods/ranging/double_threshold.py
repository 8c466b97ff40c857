"""Two thresholds on the innovations of a cubature filter, and a network that decides between them."""

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from sensorfault.core.monitor import Branch
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.ranging.chi_square_cubature import limit
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
from sensorfault.methods.ranging.ranges_learned import lessons
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.double_threshold import DoubleThreshold
from sensorfault.training.gradient import LEAST, Plan, train
from sensorfault.training.initial import new_mlp
from sensorfault.training.ranges import Lesson, Run, innovations
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows
from sensorfault.vehicles.underwater import FollowerRoles

LOW, HIGH = 0.3, 0.01  # false alarm rates of the two thresholds on their own
WINDOW, HIDDEN = 4, (10,)
PLAN = Plan(epochs=300, batch=32, rate=0.01, patience=40)


def double_threshold(
    name: str, log: Log, found: FollowerRoles, filter: Filter, of: Sequence[Lesson], seed: int = 0
) -> Model:
    """The model with a network learned from these ranges, one for all leaders.

    Raises:
        LogError: too few ranges to learn from.
    """
    residual = cubature(log, found, filter)
    runs = [run for leader in innovations(monitor(log, residual), of, residual.vehicle) for run in leader]
    windows = _windows(runs, WRONG * filter.sigma_m)
    if len(windows.first) < 3 * LEAST:
        raise LogError(
            f"{log.name} has {len(windows.first)} ranges to learn from, but {name} needs {3 * LEAST}; give a longer "
            "log."
        )
    network = train(new_mlp(seed, WINDOW, 1, HIDDEN, "sigmoid"), windows, PLAN, seed).net
    test = DoubleThreshold(
        network=network,
        low=jnp.asarray(limit(LOW)),
        high=jnp.asarray(limit(HIGH)),
        wrong=jnp.asarray(1.0),
        window=WINDOW,
        channels=len(log.channels),
    )
    calibrated = monitor(log, residual, Branch(test, on_ranges(log, found, 1.0)))
    return model(name, log, found, calibrated, ("double threshold",), filter, {"low": LOW, "high": HIGH})


def _windows(runs: Sequence[Run], wrong_m: float) -> Windows:
    """Windows of normalised innovations within each run; target: size of the newest error divided by `wrong_m`."""
    rows, first, target, begin = [], [], [], 0
    for run in runs:
        value, variance, _ = run.tape
        many = max(len(value) - WINDOW + 1, 0)
        rows.append(value / np.sqrt(variance))
        first.append(begin + np.arange(many))
        target.append(np.abs(run.error[WINDOW - 1 :][:many]) / wrong_m)
        begin += len(value)
    return Windows(np.concatenate(rows)[:, None], np.concatenate(first), np.concatenate(target)[:, None], WINDOW)


def _build(log: Log, seed: int, session: Session) -> Model:
    found = followed(RECIPE.name, log)
    session.progress("fitting the noise of ranges and dead reckoning")
    own = fitted(log, found, Filter(adaptive=False, growth=GROWTH))
    session.progress("training the network")
    return double_threshold(RECIPE.name, log, found, own, lessons(log, found, own, seed), seed)


RECIPE = Recipe(
    name="double-threshold",
    title="Cubature Kalman filter of a follower; χ² at 0.01, or at 0.3 if a network on the last four innovations "
    "agrees",
    source="the test of Zhao et al. 2020 as described by Xu et al. 2023; details are our interpretation",
    false_alarm_rate="not designed",
    build=_build,
    needs=follower,
)
