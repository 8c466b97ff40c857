"""The monitor around a conditioning residual."""

import equinox as eqx
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Monitor
from sensorfault.logs.table import Log
from sensorfault.methods.common.multivariate import limited, uncalibrated
from sensorfault.methods.common.rows import Training
from sensorfault.methods.inertial.needs import in_a_row
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.training.blocks import blocks_of
from sensorfault.training.conditioning import fit_conditioning

READMIT_S = 0.5  # a channel is trusted again this long after its last alarm [s]


def conditioned(name: str, log: Log, levels: bool = True, cross_validated: bool = True) -> Model:
    """Fit on a healthy log: first the weights, then the limits, from a replay with the limits off.

    With `levels` rows are conditioned on rows, else changes on changes. The limit comes from the largest score of the
    training data or, with `cross_validated`, of contiguous blocks left out of the fit, whichever is larger.

    Raises:
        LogError: too few complete rows, or no channel to watch.
    """
    training = in_a_row(name, log)
    residual = fit_conditioning(log.time, log.value, training.rows, training.watched, levels=levels)
    monitor = uncalibrated(log, residual, Mahalanobis(single=True), READMIT_S)
    score, runs = open_loop_scores(monitor, log)
    # (10) max(err)
    largest = float(np.nanmax(score))
    if cross_validated:
        largest = max(largest, float(np.nanmax(unseen_scores(monitor, training, levels))))
    return limited(name, training, monitor, residual.cov, "mahalanobis", largest, runs)


def unseen_scores(uncalibrated: Monitor, training: Training, levels: bool) -> Float[np.ndarray, "T K"]:
    """Score of the multivariate test for each block of the log, with weights fitted on the other blocks."""
    log, unseen = training.log, []
    for block in blocks_of(len(log)):
        known = training.rows.copy()
        known[block] = False
        other = fit_conditioning(log.time, log.value, known, training.watched, levels=levels)
        unseen.append(open_loop_scores(eqx.tree_at(lambda m: m.residual, uncalibrated, other), log)[0][block])
    return np.concatenate(unseen)
