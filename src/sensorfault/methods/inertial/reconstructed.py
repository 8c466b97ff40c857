"""The monitor around a reconstruction residual, shared by the autoencoders and their baseline."""

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.extremes import explained, explained_max
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.calibration.scaling import Scaling
from sensorfault.logs.table import Log
from sensorfault.methods.common.multivariate import limited, uncalibrated
from sensorfault.methods.common.rows import Training
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.training.cross_validation import Fit, largest_unseen_norm

READMIT_S = 2.0  # a channel is trusted again this long after its last alarm [s]


def reconstructed(name: str, log: Log, fit: Fit, cross_validated: bool = False, robust: bool = False) -> Model:
    """Fit on a healthy log: first the weights, then the limits, from a replay with the limits off.

    The limit comes from the largest error on the training data, as published; with `cross_validated` from that on
    blocks left out of the fit, if it is larger. With `robust` a few contaminated rows spoil neither scaling, weights
    nor limit: outliers are not used for any of them.

    Raises:
        LogError: too few complete rows, or no channel to watch.
    """
    training = Training.of(name, log)
    watched = training.watched
    value = np.where(watched, log.value, 0.0)[training.rows]
    if robust:
        value = value[explained(value).all(axis=1)]
    scaling = Scaling.of(value, watched)
    residual = fit(value, scaling)
    monitor = uncalibrated(log, residual, Exchange(jnp.asarray(scaling.half)), READMIT_S)
    norm, runs = open_loop_scores(monitor, log)
    # (10) max(err), over the training data
    tested = norm[np.isfinite(norm)]
    largest = explained_max(tested) if robust else float(tested.max())
    if cross_validated:
        largest = max(largest, largest_unseen_norm(value, watched, fit, scaling.half))
    return limited(name, training, monitor, residual.cov, "norm", largest, runs)
