"""What a method says of each new position, and what that is worth against the truth."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.core.verdicts import FAULT
from sensorfault.evaluation.ranking import auc
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault_studies.min2021.roc import folds

Subject = Callable[[str], bool]  # whether to include the test of that name


@dataclass(frozen=True)
class Scores:
    """At each fix: the largest score over its limit, 0 where nothing was tested, and whether the channels are FAULT.

    `score` is in open loop: no window is refilled and no reference rejected; `fault` is the verdict of the monitor in
    closed loop.
    """

    score: Float[np.ndarray, " N"]
    fault: Bool[np.ndarray, " N"]


def scored(model: Model, log: Log, rows: Int[np.ndarray, " N"], channels: tuple[int, ...], subject: Subject) -> Scores:
    """Scores and verdicts of a model on these channels, at these rows."""
    included = np.array([subject(name) for name, _ in model.tests])
    score = np.concatenate([np.asarray(x) for x in replay_log(uncalibrated(model.monitor), log).scores], axis=1)[rows]
    ratio = np.where(np.isfinite(score) & included, score / limits(model), 0.0).max(axis=1)
    verdict = np.asarray(replay_log(model.monitor, log).channel)[rows]
    return Scores(ratio, (verdict[:, list(channels)] == FAULT).any(axis=1))


def limits(model: Model) -> Float[np.ndarray, " K"]:
    """One number for each test; for a limit that depends on the score, its fixed point."""
    each = (branch.threshold for branch in model.monitor.branches)
    numbers = [one.fixed_point() if isinstance(one, ScaledMax) else getattr(one, "limit", np.nan) for one in each]
    return np.concatenate([np.atleast_1d(np.asarray(number)) for number in numbers])


def counted(frozen: Bool[np.ndarray, " N"], flagged: Bool[np.ndarray, " N"]) -> dict[str, float]:
    """Accuracy, precision, recall, F1 and false-alarm rate; 0 where there is nothing to divide."""
    tp, fp = float((frozen & flagged).sum()), float((~frozen & flagged).sum())
    fn, tn = float((frozen & ~flagged).sum()), float((~frozen & ~flagged).sum())

    def share(part: float, whole: float) -> float:
        return part / whole if whole else 0.0

    return {
        "accuracy": share(tp + tn, tp + tn + fp + fn),
        "precision": share(tp, tp + fp),
        "recall": share(tp, tp + fn),
        "f1": share(2 * tp, 2 * tp + fp + fn),
        "far": share(fp, fp + tn),
    }


def at_rate(
    time: Float[np.ndarray, " N"], healthy: Float[np.ndarray, " N"], score: Float[np.ndarray, " N"], rate: float
) -> Bool[np.ndarray, " N"]:
    """Alarms with the limit for this false alarm rate, set on every other ten seconds of the drive without faults.

    Each half is tested with the limit of the other half.
    """
    odd = folds(time)
    flagged = np.zeros(len(time), bool)
    for fold in (odd, ~odd):
        flagged[fold] = score[fold] > np.quantile(healthy[~fold], 1 - rate)
    return flagged


def flag_all(frozen: Bool[np.ndarray, " N"]) -> dict[str, float]:
    """Numbers if every fix is called frozen."""
    return counted(frozen, np.ones(len(frozen), bool)) | {"auc": 0.5, "prevalence": float(frozen.mean())}


def at_random(prevalence: float, rate: float) -> dict[str, float]:
    """Expected numbers of random alarms at this rate."""
    accuracy = prevalence * rate + (1 - prevalence) * (1 - rate)
    f1 = 2 * prevalence * rate / (prevalence + rate)
    return {"accuracy": accuracy, "precision": prevalence, "recall": rate, "f1": f1, "far": rate, "auc": 0.5}


def ranked(frozen: Bool[np.ndarray, " N"], score: Float[np.ndarray, " N"]) -> float:
    """Area under the curve."""
    return auc(score, frozen)
