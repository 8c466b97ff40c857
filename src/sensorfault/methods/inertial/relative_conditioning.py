"""Linear conditioning for smooth and rough roads: the score is divided by its own RMS over the last half second.

Changes are conditioned on changes. With levels, a lasting offset shifts what is expected of the other channels once the
faulty channel is trusted again: on the drive in Dresden an offset of 20 sigma on the yaw rate caused a false isolation
of the roll angle two seconds later, every time. With changes alone the smallest detectable spike is 2 to 11 % larger,
and there is no false isolation.
"""

from dataclasses import replace

import equinox as eqx
import jax.numpy as jnp

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.calibration.roughness import roughness
from sensorfault.logs.table import Log
from sensorfault.methods.inertial.conditioned import conditioned, unseen_scores
from sensorfault.methods.inertial.needs import in_a_row
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session

PER_HOUR = 1.0
MEMORY_S = 0.5  # the road's roughness is taken over this time [s]


def build(log: Log, seed: int, session: Session, levels: bool = False) -> Model:
    """Fit on a healthy log; with `levels` rows are conditioned on rows.

    Raises:
        LogError: too few complete rows, or no channel to watch.
    """
    model = conditioned(RECIPE.name, log, levels=levels, cross_validated=False)
    multivariate = model.monitor.branches[0]
    memory = MEMORY_S / log.period_s
    lowest, highest = roughness(open_loop_scores(model.monitor, log)[0], memory)
    relative = Relative(multivariate.statistic, jnp.asarray(memory), jnp.asarray(lowest), jnp.asarray(highest))
    monitor = eqx.tree_at(lambda m: m.branches[0], model.monitor, replace(multivariate, statistic=relative))
    session.progress("scoring blocks left out of the fit")
    limit = tail_limit(unseen_scores(monitor, in_a_row(RECIPE.name, log), levels), log.period_s, PER_HOUR)
    monitor = eqx.tree_at(lambda m: m.branches[0].threshold, monitor, Fixed(jnp.asarray(limit)))
    return replace(model, monitor=monitor, tests=(("mahalanobis, relative", None), *model.tests[1:]))


RECIPE = Recipe(
    name="relative-conditioning",
    title="Newest change given the three before it, relative to the roughness of the last half second",
    source="conditional mean of a Gaussian vector; limit from the tail of block maxima (Hosking & Wallis 1987)",
    false_alarm_rate="one false alarm an hour, extrapolated from the scores of blocks left out of the fit",
    build=build,
    needs=in_a_row,
)
