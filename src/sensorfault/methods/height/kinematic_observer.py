"""The multi-step observer without a network: the height rolled out by a measured vertical speed."""

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height import height_observer
from sensorfault.methods.height.height_observer import BLOCK_S, LEAST_WINDOWS, PER_HOUR
from sensorfault.methods.height.needs import ClimbSource, height_and_climb
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.horizons import Horizons
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.fixes import Fixes
from sensorfault.training.session import Session
from sensorfault.vehicles.height import Climb

NAME = "kinematic-observer"


@dataclass(frozen=True)
class Setting:
    """`spans_s`: lengths of the bank's roll-outs [s], rounded to whole steps; those too long for the log are left out.

    `source` of the climb rate: the receiver's vertical speed as in the paper, another sensor's, or the barometer;
    empty: the first of these that the log has. `horizon_s`: a stand-in is used for at most this long.
    """

    spans_s: tuple[float, ...] = (0.2, 1.0, 2.4, 5.0, 10.0, 30.0, 60.0)
    source: str = ""
    horizon_s: float = 30.0


def build(log: Log, seed: int, session: Session, setting: Setting = Setting()) -> Model:
    """Fit on a healthy log; the fit is deterministic.

    Raises:
        LogError: no height, no such vertical speed, or too few consecutive measurements.
    """
    heights, source = height_and_climb(NAME, log, setting.source)
    climb = climbing(source)
    fixes = heights.fixes(climb.columns)
    steps = _steps(fixes, setting)
    observer = height_observer.observer(climb, fixes, steps, heights.column)
    statistic, off = Horizons(heights.column), Fixed(height_observer.silent(len(steps)))
    uncalibrated = height_observer.monitor(log, observer, statistic, off, setting.horizon_s, fixes.period_s)
    score = open_loop_scores(uncalibrated, log)[0]
    limit = Fixed(jnp.asarray(tail_limit(score, log.period_s, PER_HOUR / len(steps), BLOCK_S)))
    calibrated = height_observer.monitor(log, observer, statistic, limit, setting.horizon_s, fixes.period_s)
    spans = [f"{n * fixes.period_s:.3g}" for n in steps]
    summary = {"limits": dict(zip(spans, np.asarray(limit.limit).tolist(), strict=True))}
    return height_observer.model(NAME, heights, calibrated, observer, fixes.period_s, summary)


def climbing(source: ClimbSource) -> Climb:
    """The step model that uses this source."""
    return Climb(jnp.asarray(source.upward), (source.column,), source.speed)


def _steps(fixes: Fixes, setting: Setting) -> tuple[int, ...]:
    """The bank's numbers of steps.

    Raises:
        LogError: the log is too short even for the shortest.
    """
    wanted = height_observer.in_steps(setting.spans_s, fixes)
    steps = tuple(n for n in wanted if len(fixes.windows(n)) >= LEAST_WINDOWS)
    if not steps:
        raise LogError(
            f"{fixes.name} has {len(fixes.windows(wanted[0]))} runs of {wanted[0]} heights without a gap, but "
            f"{NAME} needs {LEAST_WINDOWS}; give it more data, or data with fewer gaps."
        )
    return steps


def _build(log: Log, seed: int, session: Session) -> Model:
    return build(log, seed, session)


RECIPE = Recipe(
    name=NAME,
    title="Height predicted from a measured vertical speed over 0.2 s to 60 s, one limit for each span",
    source="Wang S. et al., flapping-wing aircraft, with the vertical speed and without the network",
    false_alarm_rate="1 false alarm an hour over all limits, from the tails of the healthy residuals",
    build=_build,
    needs=height_and_climb,
)
