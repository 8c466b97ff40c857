"""The method of Wang S. et al.: a network predicts an aircraft's height over N steps; the limit follows its error."""

from dataclasses import dataclass, field, replace
from statistics import NormalDist

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.limits import tail_limit
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height import height_observer
from sensorfault.methods.height.height_observer import BLOCK_S, PER_HOUR
from sensorfault.methods.height.heights import Heights
from sensorfault.methods.height.needs import height_and_inputs
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.horizons import Horizons
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.threshold.adaptive import Adaptive
from sensorfault.training.fixes import Fixes
from sensorfault.training.height_kalman import fit_height_kalman
from sensorfault.training.multistep import Schedule, train_steps
from sensorfault.training.roll_out import errors
from sensorfault.training.session import Session

NAME = "multistep-observer"
TRAINING_SHARE = 0.7  # of the healthy log; the limits come from the rest
ALPHA = 0.01  # false alarm probability of the companion filter's chi-square test, as in the paper
CHI_SQUARE = NormalDist().inv_cdf(1 - ALPHA / 2) ** 2  # with one degree of freedom
OFF = 1e9  # factor that raises the limits beyond every score


@dataclass(frozen=True)
class Setting:
    """`steps`: numbers N of steps, each a member of the bank; the paper finds 12 best. `spans_s`: the same in seconds,
    used instead if given. The network is trained over the longest. `horizon_s`: a stand-in is used for at most this
    long. `printed`: a = b = 1 as in the paper; by default both are set for the designed false alarm rate.
    """

    steps: tuple[int, ...] = (12,)
    spans_s: tuple[float, ...] = ()
    horizon_s: float = 10.0
    printed: bool = False
    schedule: Schedule = field(default_factory=Schedule)


def build(log: Log, seed: int, session: Session, setting: Setting = Setting()) -> Model:
    """Fit on a healthy log: the height from vertical speed, pitch, throttle and elevator, as far as the log has them.

    Raises:
        LogError: no height, no input to predict it from, or too few consecutive measurements.
    """
    heights, columns = height_and_inputs(NAME, log)
    cut = log.time[0] + TRAINING_SHARE * log.duration_s
    learn, unseen = heights.fixes(columns, end_s=cut), heights.fixes(columns, cut)
    steps = _steps(learn, unseen, setting)
    session.progress(f"training a network over {max(steps)} steps")
    trained = train_steps(learn, (max(steps),), (seed,), setting.schedule)
    (network,) = trained.nets[0]
    session.progress("measuring its residual")
    observer = height_observer.observer(network, unseen, steps, heights.column)
    companion = fit_height_kalman(log, heights.column, heights.roles)
    mine = np.arange(len(log.channels)) == heights.column
    residual = Several((observer, companion), jnp.asarray(np.stack([mine, mine & False])))
    threshold = Adaptive(
        a=jnp.ones(len(steps)),
        b=jnp.ones(len(steps)),
        typical=jnp.asarray(np.sqrt(np.mean(errors(network, unseen, steps) ** 2, axis=1))),
        chi_square=jnp.asarray(CHI_SQUARE),
        part=1,
        column=heights.column,
    )
    if not setting.printed:
        threshold = _calibrated(heights, residual, threshold, setting, unseen.period_s, cut)
    weights = {"a": np.asarray(threshold.a).tolist(), "b": np.asarray(threshold.b).tolist()}
    summary = {"epochs": int(np.isfinite(trained.loss[0, 0]).sum()), **weights}
    calibrated = height_observer.monitor(
        log, residual, _statistic(heights), threshold, setting.horizon_s, unseen.period_s
    )
    return height_observer.model(NAME, heights, calibrated, observer, unseen.period_s, summary)


def _steps(learn: Fixes, unseen: Fixes, setting: Setting) -> tuple[int, ...]:
    """The bank's numbers of steps.

    Raises:
        LogError: the part of the log that is not used for training is too short for one of them.
    """
    steps = height_observer.in_steps(setting.spans_s, learn) if setting.spans_s else setting.steps
    for n in steps:
        if not len(unseen.windows(n)):
            raise LogError(
                f"{learn.name} has no {n} heights in a row without a gap in its last part, on which {NAME} sets its "
                "limits; give it more data, or take fewer steps."
            )
    return steps


def _statistic(heights: Heights) -> SelectResidual:
    return SelectResidual(Horizons(heights.column), 0)


def _calibrated(
    heights: Heights, residual: Several, threshold: Adaptive, setting: Setting, period_s: float, cut: float
) -> Adaptive:
    """a = b such that healthy data exceed the limit PER_HOUR times an hour, from the part not used for training."""
    off = replace(threshold, a=threshold.a * OFF, b=threshold.b * OFF)
    log = heights.log
    uncalibrated = height_observer.monitor(log, residual, _statistic(heights), off, setting.horizon_s, period_s)
    tape = replay_log(uncalibrated, log)
    ratio = np.asarray(tape.scores[0]) / np.asarray(tape.limits[0]) * OFF
    factor = tail_limit(ratio[log.time >= cut], log.period_s, PER_HOUR / ratio.shape[1], BLOCK_S)
    return replace(threshold, a=jnp.asarray(factor), b=jnp.asarray(factor))


RECIPE = Recipe(
    name=NAME,
    title="Height predicted over 12 steps by a network that feeds its own prediction back; the limit follows a "
    "companion filter and the observer's own error",
    source="Wang S. et al., multi-step neural network observer of a flapping-wing aircraft",
    false_alarm_rate="1 false alarm an hour, from the tail of residual over limit on data not used for training",
    build=build,
    needs=height_and_inputs,
)
