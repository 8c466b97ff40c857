"""A conditioning residual made into a monitor."""

import equinox as eqx
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.methods.joint import Training, deaf, limited
from sensorfault.model import Model
from sensorfault.monitor.monitor import Monitor
from sensorfault.monitor.statistic.mahalanobis import Mahalanobis
from sensorfault.training.conditioning import LAGS, fit_conditioning
from sensorfault.training.cross_validation import BLOCKS
from sensorfault.training.tapes import score_tape

READMIT_S = 0.5  # a channel is taken at its own word again so long after the last accusation


def conditioned(name: str, log: Log, lags: int = LAGS, single: bool = True, cross_validated: bool = True) -> Model:
    """Fit on a healthy log: weights, then the limits from a replay with the limits off.

    The largest healthy score is that of the training data or, with `cross_validated`, of contiguous blocks left out of
    the fit, if it is larger.

    Raises:
        LogError: too few complete rows, or nothing to watch.
    """
    training = Training.of(name, log)
    residual = fit_conditioning(log.time, log.value, training.rows, training.watched, lags)
    monitor = deaf(log, residual, Mahalanobis(single), READMIT_S)
    score, runs = score_tape(monitor, log)
    # (10) max(err)
    largest = float(np.nanmax(score))
    if cross_validated:
        largest = max(largest, float(np.nanmax(unseen_scores(monitor, training, lags))))
    return limited(name, training, monitor, residual.cov, "mahalanobis", largest, runs)


def unseen_scores(deaf: Monitor, training: Training, lags: int = LAGS) -> Float[np.ndarray, "T K"]:
    """The joint test's score of each block of the log, by weights fitted on the other blocks."""
    log, unseen = training.log, []
    for block in np.array_split(np.arange(len(log)), BLOCKS):
        known = training.rows.copy()
        known[block] = False
        other = fit_conditioning(log.time, log.value, known, training.watched, lags)
        unseen.append(score_tape(eqx.tree_at(lambda m: m.residual, deaf, other), log)[0][block])
    return np.concatenate(unseen)
