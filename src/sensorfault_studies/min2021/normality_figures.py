"""Figures of A3: innovations against the normal distribution (figure 6 of the paper), and Jarque-Bera over time."""

import numpy as np

from sensorfault.logs.table import Log
from sensorfault.numerics.normality import jarque_bera_quantile
from sensorfault.runtime.replay import replay_log
from sensorfault.training.bicycle import normalised
from sensorfault_studies.findings import Figure
from sensorfault_studies.min2021.normality_faults import Judged


def figures(data: str, one: Judged, whole: Log, kept: dict[str, list[np.ndarray]]) -> list[Figure]:
    """Both figures of one drive."""
    return [_histogram(data, one, whole), _over_time(data, one, whole)]


def _histogram(data: str, one: Judged, whole: Log) -> Figure:
    x = normalised(one.filter, whole)[:, list(one.filter.columns.position)]
    x = x[np.isfinite(x)]
    edges = np.linspace(-6, 6, 61)
    middle = (edges[1:] + edges[:-1]) / 2
    density = np.histogram(np.clip(x, -6, 6), edges)[0] / x.size / (edges[1] - edges[0])
    normal = np.exp(-(middle**2) / 2) / np.sqrt(2 * np.pi)
    fitted = np.exp(-((middle - x.mean()) ** 2) / 2 / x.var()) / np.sqrt(2 * np.pi * x.var())
    plot = {
        "data": [
            {"type": "bar", "name": "innovations", "x": middle.tolist(), "y": density.tolist()},
            {
                "type": "scatter",
                "name": "normal, as predicted",
                "x": middle.tolist(),
                "y": normal.tolist(),
            },
            {"type": "scatter", "name": "normal, fitted", "x": middle.tolist(), "y": fitted.tolist()},
        ],
        "layout": {
            "xaxis": {"title": {"text": "innovation of the position over its standard deviation"}},
            "yaxis": {"title": {"text": "density"}},
        },
    }
    caption = (
        "Narrower in the middle and wider in the tails than a normal distribution; the outer bars contain everything "
        "beyond."
    )
    return Figure(f"a3-residuals-{data}", f"Innovations of the position, {data}", caption, plot)


def _over_time(data: str, one: Judged, whole: Log) -> Figure:
    scores = np.asarray(replay_log(one.model.monitor, whole).scores[1])
    lines = []
    for k, column in enumerate(one.filter.columns.position):
        rows = np.flatnonzero(np.isfinite(scores[:, k]))[::10]
        name = whole.channels[column].path
        lines.append(
            {
                "type": "scatter",
                "name": name,
                "x": np.round(whole.time[rows], 2).tolist(),
                "y": np.round(scores[rows, k], 3).tolist(),
            }
        )
    levels = {"5 % of normal samples": float(jarque_bera_quantile(20.0, 0.95)), "paper's largest": 0.34}
    for name, level in levels.items():
        span = [float(whole.time[0]), float(whole.time[-1])]
        lines.append({"type": "scatter", "name": name, "x": span, "y": [level, level], "line": {"dash": "dash"}})
    layout = {
        "xaxis": {"title": {"text": "time [s]"}},
        "yaxis": {"title": {"text": "Jarque-Bera"}, "type": "log"},
    }
    caption = "On a healthy drive, decimated as in the recipe: bursts of the receiver's errors raise it, not faults."
    return Figure(
        f"a3-jarque-bera-{data}", f"Jarque-Bera over time, {data}", caption, {"data": lines, "layout": layout}
    )
