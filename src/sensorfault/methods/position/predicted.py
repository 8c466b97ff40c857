"""The monitor around a residual of the position, shared by the predictors and their baselines."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import open_loop
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position.positions import GAP, LEAST_FIXES, Positions
from sensorfault.numerics.networks.dense import Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.displacement import Displacement
from sensorfault.stages.residual.extrapolation import Extrapolation
from sensorfault.stages.residual.prediction import Prediction
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault.training.inputs import Inputs
from sensorfault.training.prediction import prediction_windows
from sensorfault.training.windows import Windows

LENGTH = 30  # rows of the window; s in Min et al. 2021
REBUILD_S = 3.0  # a stand-in is used for at most this long [s]
READMIT_S = 0.5  # a channel is trusted again this long after its last alarm [s]


def from_windows(name: str, log: Log, length: int, fit: Callable[[Windows], Linear | Mlp | Lstm]) -> Model:
    """The model of a network that predicts the position from the last `length` rows, fitted on a healthy log.

    Raises:
        LogError: no positions, too few positions, or a car that never moves.
    """
    positions = Positions.of(name, log)
    inputs = Inputs.of(log, positions.inputs, 2, positions.turning)
    gap_s = GAP * log.period_s
    stale_s = positions.stale_s[list(positions.columns)]
    network = fit(prediction_windows(log, inputs, length, gap_s, stale_s))
    residual = Prediction(
        network=network,
        center=jnp.asarray(inputs.center),
        half=jnp.asarray(inputs.half),
        angle=jnp.asarray(inputs.angle),
        cov=jnp.eye(len(log.channels)),
        gap_s=jnp.asarray(gap_s),
        stale_s=jnp.asarray(stale_s),
        length=length,
        inputs=inputs.columns,
    )
    return limited(name, positions, residual, {"inputs": [log.channels[i].path for i in inputs.columns]})


def limited(
    name: str,
    positions: Positions,
    residual: Prediction | Extrapolation | Displacement,
    extra: dict[str, Any],
    unit: Float[np.ndarray, "2"] | None = None,
) -> Model:
    """The model, with covariance and largest error from a replay with the limit off.

    Errors of latitude and longitude are divided by `unit` [rad]; by default half the training range. `extra` goes into
    the summary.

    Raises:
        LogError: too few positions that can be tested.
    """
    log, columns = positions.log, list(positions.columns)
    channels = len(log.channels)
    scale = np.ones(channels)
    scale[columns] = positions.half if unit is None else unit
    uncalibrated = Monitor(
        residual=residual,
        branches=(Branch(Norm(jnp.asarray(scale)), ScaledMax(jnp.full(1, jnp.inf))),),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(READMIT_S), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        most=1,
    )
    tape = open_loop(uncalibrated, log)
    tested = np.asarray(tape.valid)[:, columns].all(axis=1)
    if tested.sum() < LEAST_FIXES:
        raise LogError(
            f"{log.name} has {tested.sum()} positions after a window without gaps, but {name} needs {LEAST_FIXES}; "
            "give it more data, or data with fewer gaps."
        )
    cov = np.eye(channels)
    at = np.array(columns)
    cov[at[:, None], at] = np.cov(np.asarray(tape.residual)[tested][:, columns].T)
    # (10) max(err) of the 2-norm (13)-(15), over the training data
    largest = np.nanmax(tape.scores[0], axis=0)
    monitor = eqx.tree_at(
        lambda m: (m.residual.cov, m.branches[0].threshold.largest),
        uncalibrated,
        (jnp.asarray(cov), jnp.asarray(largest)),
    )
    watched = positions.mark(positions.columns)
    reasons = {c.path: "not predicted" for c, w in zip(log.channels, watched, strict=True) if not w}
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "rows": int(tested.sum()),
        "not_watched": reasons,
        **extra,
    }
    sigma = tuple(np.sqrt(np.diag(cov)).tolist())
    tests = (("norm", None),)
    return Model(name, monitor, log.channels, log.sensors, tests, tuple(watched.tolist()), log.period_s, sigma, summary)
