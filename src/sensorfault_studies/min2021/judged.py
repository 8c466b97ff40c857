"""One method on the spikes of one drive, seed by seed: AUC, recall and false alarm rate."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.evaluation.ranking import auc
from sensorfault.runtime.model import Model
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault_studies.min2021.copiers import Candidate
from sensorfault_studies.min2021.roc import curve, detected, folds
from sensorfault_studies.min2021.spikes import Drive, judged_rows, left_of_spikes, spiked

PLAIN = 5.0
RATES = {"far1e-2": 1e-2, "far1e-3": 1e-3}
Key = tuple[str, str, float | None]  # condition, metric, magnitude


@dataclass
class Judged:
    """The numbers of one method on one drive, one value for each seed.

    `left`: healthy residual as a share of a channel's sigma. `spike_left`: share of a spike of PLAIN sigmas that
    remains in the residual. `curve`: false alarm rate and recall over all sizes, of the first seed.
    """

    number: dict[Key, list[float]] = field(default_factory=dict)
    left: list[float] = field(default_factory=list)
    spike_left: list[float] = field(default_factory=list)
    curve: tuple[list[float], list[float]] = ([], [])

    def add(self, condition: str, metric: str, size: float | None, value: float) -> None:
        """Add the value of one more seed."""
        self.number.setdefault((condition, metric, size), []).append(value)

    def mean(self, condition: str, metric: str, size: float | None = None) -> float:
        """Mean over the seeds."""
        return float(np.mean(self.number[condition, metric, size]))


def judge(drive: Drive, rival: Candidate, sizes: Sequence[float], seeds: range) -> Judged:
    """Fit, replay the rest of the drive without and with spikes, and count."""
    judged = Judged()
    odd = folds(drive.rest.time)
    model = None
    for seed in seeds:
        if model is None or rival.chance:
            model, took = rival.build(drive.learn, seed)
            judged.add(rival.condition, "fit_s", None, took)
            judged.left.append(float(np.mean(np.array(model.sigma) / drive.sigma)))
        monitor = uncalibrated(model.monitor)
        clean = judged_rows(monitor, drive.rest)
        healthy = clean.score
        judged.add(rival.limit, "far", None, float(over(model, healthy).mean()))
        all_scores, all_faulty = [], []
        for size in sizes:
            log, faulty = spiked(drive, size, seed)
            there = judged_rows(monitor, log)
            score = there.score
            if size == PLAIN:
                judged.spike_left.append(left_of_spikes(drive, log, there, clean))
            judged.add(rival.condition, "auc", size, auc(score, faulty))
            judged.add(rival.limit, "recall", size, float(over(model, score)[faulty].mean()))
            for name, rate in RATES.items():
                recall, false = detected(healthy, score, faulty, odd, rate)
                judged.add(name, "recall", size, recall)
                if size == sizes[0]:
                    judged.add(name, "far", None, false)
            all_scores.append(score)
            all_faulty.append(faulty)
        pooled, marks = np.concatenate(all_scores), np.concatenate(all_faulty)
        judged.add(f"{rival.condition} pooled", "auc", None, auc(pooled, marks))
        judged.add(f"{rival.limit} fixed-point", "agreement", None, agreement(model, pooled))
        judged.curve = judged.curve if judged.curve[0] else curve(pooled, marks)
    return judged


def _limit(model: Model) -> ScaledMax:
    threshold = model.monitor.branches[0].threshold
    assert isinstance(threshold, ScaledMax)
    return threshold


def over(model: Model, score: Float[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
    """Which scores exceed the fitted limit (10)-(11), by its only fixed point."""
    return np.asarray(score > float(_limit(model).fixed_point()[0]))


def agreement(model: Model, score: Float[np.ndarray, " T"]) -> float:
    """Share of the scores for which the limit (11), which depends on the score, decides like its fixed point."""
    # (10), (11) delta = (1 + 1 / (1 + e^score)) max(err)
    delta = (1 + 1 / (1 + np.exp(np.minimum(score, 700.0)))) * np.asarray(jnp.squeeze(_limit(model).largest))
    return float(((score > delta) == over(model, score)).mean())
