"""One detector of shorts on one drive, seed by seed: how well it ranks, what it finds at which price."""

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
    """`number`: one value a seed. `left`: share of a channel's sigma that the model leaves of healthy rows.

    `spike_left`: share that it leaves of spikes of PLAIN sigmas.

    `curve`: false-alarm rate and recall over all sizes together, of the first seed.
    """

    number: dict[Key, list[float]] = field(default_factory=dict)
    left: list[float] = field(default_factory=list)
    spike_left: list[float] = field(default_factory=list)
    curve: tuple[list[float], list[float]] = ([], [])

    def add(self, condition: str, metric: str, size: float | None, value: float) -> None:
        """One more seed's value."""
        self.number.setdefault((condition, metric, size), []).append(value)

    def mean(self, condition: str, metric: str, size: float | None = None) -> float:
        """Over the seeds."""
        return float(np.mean(self.number[condition, metric, size]))


def judge(drive: Drive, rival: Candidate, sizes: Sequence[float], seeds: range) -> Judged:
    """Fit, replay the rest of the drive untouched and spiked, count."""
    result = Judged()
    odd = folds(drive.rest.time)
    model = None
    for seed in seeds:
        if model is None or rival.chance:
            model, took = rival.build(drive.learn, seed)
            result.add(rival.condition, "fit_s", None, took)
            result.left.append(float(np.mean(np.array(model.sigma) / drive.sigma)))
        monitor = uncalibrated(model.monitor)
        clean = judged_rows(monitor, drive.rest)
        healthy = clean.score
        result.add(rival.limit, "far", None, float(over(model, healthy).mean()))
        all_scores, all_struck = [], []
        for size in sizes:
            log, struck = spiked(drive, size, seed)
            there = judged_rows(monitor, log)
            score = there.score
            if size == PLAIN:
                result.spike_left.append(left_of_spikes(drive, log, there, clean))
            result.add(rival.condition, "auc", size, auc(score, struck))
            result.add(rival.limit, "recall", size, float(over(model, score)[struck].mean()))
            for name, rate in RATES.items():
                recall, false = detected(healthy, score, struck, odd, rate)
                result.add(name, "recall", size, recall)
                if size == sizes[0]:
                    result.add(name, "far", None, false)
            all_scores.append(score)
            all_struck.append(struck)
        pooled, marks = np.concatenate(all_scores), np.concatenate(all_struck)
        result.add(f"{rival.condition} pooled", "auc", None, auc(pooled, marks))
        result.add(f"{rival.limit} fixed-point", "agreement", None, agreement(model, pooled))
        result.curve = result.curve if result.curve[0] else curve(pooled, marks)
    return result


def _limit(model: Model) -> ScaledMax:
    threshold = model.monitor.branches[0].threshold
    assert isinstance(threshold, ScaledMax)
    return threshold


def over(model: Model, score: Float[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
    """Which scores the fitted limit (10)-(11) calls a fault, by its one fixed point."""
    return np.asarray(score > float(_limit(model).fixed_point()[0]))


def agreement(model: Model, score: Float[np.ndarray, " T"]) -> float:
    """Share of the scores on which the limit that follows the score, (11), decides as its fixed point does."""
    # (10), (11) delta = (1 + 1 / (1 + e^score)) max(err)
    delta = (1 + 1 / (1 + np.exp(np.minimum(score, 700.0)))) * np.asarray(jnp.squeeze(_limit(model).largest))
    return float(((score > delta) == over(model, score)).mean())
