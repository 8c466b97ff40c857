"""Does the car go where it points: the side force that it feels against the one that its turning asks for."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import MOTION, Model, hold_s, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.lasting import Lasting
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.mounting import fit_mounting
from sensorfault.training.session import Session
from sensorfault.training.side_force import fit_side_force
from sensorfault.vehicles.car import roles

CONSTANT_S = 0.3  # of the low pass: longer than a bump, shorter than the edge of a slide
# After a fault of a sensor nothing is said for so long [s]: an offset of the yaw rate that lasts, once it is taken for
# the channel's own word again, is a slide as long as it lasts.
MEMORY_S = 20.0
PER_HOUR = 1.0  # false alarms
MARGIN = 1.25  # on the limit, for what a drive of minutes has not shown


def _build(log: Log, seed: int, session: Session) -> Model:
    session.tell("learning the side force of healthy turns")
    residual = fit_side_force(log, roles(log))
    columns = (*residual.unit.gyro, *residual.unit.accelerometer, *residual.velocity)
    compared = np.isin(np.arange(len(log.channels)), columns)
    statistic = Lasting(jnp.asarray(CONSTANT_S), jnp.asarray(compared))
    uncalibrated = Monitor(
        residual=residual,
        branches=(Branch(statistic, Fixed(jnp.full(1, jnp.inf)), subject=MOTION, memory_s=MEMORY_S, excuses=True),),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )
    limit = MARGIN * tail_limit(open_loop_scores(uncalibrated, log)[0], log.period_s, PER_HOUR)
    result = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "not_watched": {
            c.path: "no part of the comparison" for c, mine in zip(log.channels, compared, strict=True) if not mine
        },
    }
    return Model(
        method=RECIPE.name,
        monitor=eqx.tree_at(lambda m: m.branches[0].threshold.limit, uncalibrated, jnp.asarray(limit)),
        channels=log.channels,
        sensors=log.sensors,
        tests=(("side force", MOTION),),
        watched=tuple(compared.tolist()),
        tick_s=log.period_s,
        sigma=(1.0,) * len(log.channels),
        summary=result,
    )


RECIPE = Recipe(
    name="side-force",
    title="Side force felt minus speed times turn rate: a car that slips, spins or is carried; judges the motion, "
    "given healthy sensors",
    source="the bicycle of Min et al. 2021, equation (16), which does not slip; the comparison that stability "
    "controllers make (van Zanten 2000)",
    promise="one false alarm an hour, extrapolated from the tail of the training drive, and a quarter on top",
    build=_build,
    needs=lambda log: fit_mounting(log, roles(log)),
)
