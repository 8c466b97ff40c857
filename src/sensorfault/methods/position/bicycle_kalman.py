"""Does the car move where its wheels point? A Kalman filter on the kinematic bicycle, tested at once and over 10 s."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.calibration.gumbel import gumbel_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.calibration.whiteness import whiten
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.methods.position.needs import bicycle
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.normality import jarque_bera_quantile
from sensorfault.runtime.model import MOTION, Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.bicycle_kalman import LOST_S
from sensorfault.stages.statistic.normality import Normality
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.bicycle import WARM_S, fit_bicycle, normalised
from sensorfault.training.session import Session
from sensorfault.vehicles.car import roles

WINDOW_S = 10.0  # of the Jarque-Bera test, as published
INSTANT_BLOCK_S = 5.0  # alarms of the instant tests within this time count once [s]
PER_HOUR = 1.0  # false alarms: half for the instant tests, half for the windows
MARGIN = 1.25  # factor on the limits of the windows: a training drive of minutes does not show everything
LEAST_Z = 4.5  # smallest limit for mean and variance: sliding windows of pure noise already reach this


def bicycle_kalman(name: str, log: Log) -> Model:
    """Fit on a healthy drive of a car.

    Raises:
        LogError: no position, no speed, neither yaw rate nor steering angle, no wheelbase, or a car that never moves.
    """
    filter = fit_bicycle(log, roles(log), log.wheelbase_m, log.steering_ratio)
    measured, channels = filter.columns.measured, len(log.channels)
    white = whiten(normalised(filter, log)[log.time > log.time[0] + WARM_S][:, list(measured)], _warm(log), WINDOW_S)
    window = Normality(
        watched=measured,
        channels=channels,
        memory=jnp.asarray(white.memory),
        sigma=jnp.asarray(white.sigma),
        least=jnp.asarray(white.least),
        every=jnp.asarray(white.every, float),
        window_s=jnp.asarray(WINDOW_S),
    )
    groups = (filter.columns.position, filter.columns.velocity)
    silent = [Fixed(jnp.full(k, jnp.inf)) for k in (len(groups), 3 * len(measured))]
    uncalibrated = Monitor(
        residual=filter,
        branches=(
            Branch(Whitened(groups, channels), silent[0], subject=MOTION, memory_s=LOST_S),
            Branch(window, silent[1], gates=False, subject=MOTION, memory_s=LOST_S + WINDOW_S),
        ),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )
    monitor = eqx.tree_at(
        lambda m: [b.threshold.limit for b in m.branches], uncalibrated, _limits(uncalibrated, window, log)
    )
    tests = [f"whitened innovation of {what}" for what in ("position", "velocity")]
    paths = [log.channels[c].path for c in measured]
    tests += [f"{test} of {path}" for test in ("Jarque-Bera", "mean", "variance") for path in paths]
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "turned_by": "steering angle" if filter.columns.steering else "yaw rate",
        "not_watched": {c.path: "not measured" for i, c in enumerate(log.channels) if i not in measured},
    }
    return Model(
        method=name,
        monitor=monitor,
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple((test, MOTION) for test in tests),
        watched=tuple(i in measured for i in range(channels)),
        tick_s=log.period_s,
        sigma=(1.0,) * channels,
        summary=summary,
    )


def _warm(log: Log) -> Float[np.ndarray, " T"]:
    times: Float[np.ndarray, " T"] = log.time[log.time > log.time[0] + WARM_S]
    return times


def _limits(uncalibrated: Monitor, window: Normality, log: Log) -> list[Float[Array, " K"]]:
    """Limits from the training drive; half of the allowed alarms go to the instant tests, half to the windows."""
    rows = log.time > log.time[0] + WARM_S
    instant, windows = (tape[rows] for tape in open_loop_scores(uncalibrated, log))
    at_once = gumbel_limit(instant, _warm(log), PER_HOUR / 2 / instant.shape[1], INSTANT_BLOCK_S)
    share = PER_HOUR / 2 / windows.shape[1]
    width = len(window.watched)
    # on the square root, which is about the kurtosis: the Jarque-Bera statistic itself has a heavy tail
    normal = gumbel_limit(np.sqrt(windows[:, :width]), _warm(log), share, WINDOW_S) ** 2
    chance = 1 - share * WINDOW_S / 3600
    finite = jarque_bera_quantile(WINDOW_S / np.asarray(window.every) / _periods(log, window.watched), chance)
    rest = gumbel_limit(windows[:, width:], _warm(log), share, WINDOW_S)
    long = MARGIN * np.concatenate([np.maximum(normal, finite), np.maximum(rest, LEAST_Z)])
    return [jnp.asarray(at_once), jnp.asarray(long)]


def _periods(log: Log, columns: tuple[int, ...]) -> Float[np.ndarray, " W"]:
    return np.array([float(np.median(np.diff(log.time[log.fresh[:, c]]))) for c in columns])


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting noise and lags of the bicycle model")
    return bicycle_kalman(RECIPE.name, log)


RECIPE = Recipe(
    name="bicycle-kalman",
    title="Kalman filter on the kinematic bicycle: whitened innovation of each sample; Jarque-Bera, mean and "
    "variance over 10 s; tests the motion, assumes healthy sensors",
    source="Min et al. 2021, section 3, equations (16)-(26)",
    false_alarm_rate="one false alarm an hour, extrapolated from the block maxima of the training drive; the limits "
    "of the windows are 25 % higher than that",
    build=_build,
    needs=bicycle,
)
