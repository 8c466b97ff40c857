"""Linear conditioning on roads of every kind: the newest change by those before it, and by the last half second.

It conditions changes on changes. With levels an offset that lasts, once it is taken for the channel's own word again,
moves what is expected of the others: on Dresden's drive 20 sigmas on the yaw rate had the roll angle accused two
seconds later, each time. Changes alone cost 2 to 11 % of the smallest spike that can be seen, and nothing is accused.
"""

from dataclasses import replace
from functools import partial

import equinox as eqx
import jax.numpy as jnp

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores, uncalibrated
from sensorfault.calibration.roughness import roughness
from sensorfault.logs.table import Log
from sensorfault.methods.inertial.conditioned import conditioned, in_a_row, unseen_scores
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session

PER_HOUR = 1.0
MEMORY_S = 0.5  # a road is as rough as it was for so long


def build(log: Log, seed: int, session: Session, levels: bool = False) -> Model:
    """Fit on a healthy log; with `levels` rows are conditioned on rows.

    Raises:
        LogError: too few complete rows, or nothing to watch.
    """
    model = conditioned(RECIPE.name, log, levels=levels, cross_validated=False)
    joint = model.monitor.branches[0]
    memory = MEMORY_S / log.period_s
    lowest, highest = roughness(open_loop_scores(uncalibrated(model.monitor), log)[0], memory)
    relative = Relative(joint.statistic, jnp.asarray(memory), jnp.asarray(lowest), jnp.asarray(highest))
    monitor = eqx.tree_at(lambda m: m.branches[0], model.monitor, replace(joint, statistic=relative))
    session.tell("scoring blocks left out of the fit")
    limit = tail_limit(unseen_scores(uncalibrated(monitor), in_a_row(RECIPE.name, log), levels), log.period_s, PER_HOUR)
    monitor = eqx.tree_at(lambda m: m.branches[0].threshold, monitor, Fixed(jnp.asarray(limit)))
    return replace(model, monitor=monitor, tests=(("mahalanobis, relative", None), *model.tests[1:]))


RECIPE = Recipe(
    name="relative-conditioning",
    title="Newest change given the three before it, against the roughness of the last half second",
    source="conditional mean of a Gaussian vector; the limit a tail of block maxima (Hosking & Wallis 1987)",
    promise="one false alarm an hour, extrapolated from the scores of blocks left out of the fit",
    build=build,
    needs=partial(in_a_row, "relative-conditioning"),
)
