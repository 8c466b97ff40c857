"""Does the car slide? The measured side force against the one that speed and turn rate require."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.methods.position.needs import inertial_and_velocity
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import MOTION, Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.lasting import Lasting
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session
from sensorfault.training.side_force import fit_side_force
from sensorfault.vehicles.car import roles

CONSTANT_S = 0.3  # time constant of the low pass: longer than a bump, shorter than the onset of a slide [s]
# No verdict for this long after a sensor fault [s]: a lasting offset of the yaw rate looks like a slide once the
# channel is trusted again.
MEMORY_S = 20.0
PER_HOUR = 1.0  # false alarms an hour
MARGIN = 1.25  # factor on the limit: a training drive of minutes does not show everything


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("measuring the side force in healthy turns")
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
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "not_watched": {
            c.path: "not part of the comparison" for c, mine in zip(log.channels, compared, strict=True) if not mine
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
        summary=summary,
    )


RECIPE = Recipe(
    name="side-force",
    title="Measured side force minus speed times turn rate: a car that slides, spins or is transported; tests the "
    "motion, assumes healthy sensors",
    source="the bicycle of Min et al. 2021, equation (16), which does not slide; the comparison made by stability "
    "controllers (van Zanten 2000)",
    false_alarm_rate="one false alarm an hour, extrapolated from the tail of the training drive; the limit is 25 % "
    "higher",
    build=_build,
    needs=inertial_and_velocity,
)
