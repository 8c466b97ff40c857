"""ROC curve of scores, and detection at a false alarm rate that was set on other healthy rows."""

import numpy as np
from jaxtyping import Bool, Float

from sensorfault_studies.findings import Json

FOLD_S = 10.0
_POINTS = 200


def folds(time: Float[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
    """Every other ten seconds: one half sets the limit for the other."""
    odd: Bool[np.ndarray, " T"] = ((time - time[0]) // FOLD_S) % 2 == 1
    return odd


def detected(
    healthy: Float[np.ndarray, " T"],
    score: Float[np.ndarray, " T"],
    faulty: Bool[np.ndarray, " T"],
    odd: Bool[np.ndarray, " T"],
    rate: float,
) -> tuple[float, float]:
    """Recall of the faulty rows and achieved false alarm rate, with limits for `rate` from the other fold.

    `healthy`: scores of the same rows without faults.
    """
    recall, false = [], []
    for fold in (odd, ~odd):
        limit = np.quantile(healthy[~fold], 1 - rate)
        recall.append(score[faulty & fold] > limit)
        false.append(healthy[fold] > limit)
    return float(np.concatenate(recall).mean()), float(np.concatenate(false).mean())


def curve(score: Float[np.ndarray, " T"], faulty: Bool[np.ndarray, " T"]) -> tuple[list[float], list[float]]:
    """False alarm rate and recall from the highest limit to the lowest, in a few hundred points."""
    order = faulty[np.argsort(-score, kind="stable")]
    recall, false = np.cumsum(order) / order.sum(), np.cumsum(~order) / (~order).sum()
    # as many points along the recall as along the rate
    at = np.searchsorted(recall + false, np.linspace(0, 2, _POINTS)).clip(max=len(order) - 1)
    return [0.0, *false[at].round(5).tolist(), 1.0], [0.0, *recall[at].round(5).tolist(), 1.0]


def plot(curves: dict[str, tuple[list[float], list[float]]]) -> Json:
    """Plotly JSON of curves by name, with chance as a dotted line."""
    lines = [
        {"type": "scatter", "mode": "lines", "name": name, "x": false, "y": recall}
        for name, (false, recall) in curves.items()
    ]
    chance = {"type": "scatter", "mode": "lines", "name": "chance", "x": [0, 1], "y": [0, 1], "line": {"dash": "dot"}}
    axes = {"xaxis": {"title": {"text": "false alarm rate"}}, "yaxis": {"title": {"text": "recall"}}}
    return {"data": [*lines, chance], "layout": axes}
