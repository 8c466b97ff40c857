"""Figures 13 to 19 of the paper: flagged ranges, scores, and the position error of the follower."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from sensorfault_studies.findings import Figure, Json
from sensorfault_studies.xu2023.contenders import POOL_OF_MISSIONS
from sensorfault_studies.xu2023.missions import Result
from sensorfault_studies.xu2023.run import Flown
from sensorfault_studies.xu2023.scenario import TRAINED_S, WRONG_M, Scenario

RULES = f"anfis-cubature-9m {POOL_OF_MISSIONS}"
SHOWN = ("chi-square-ckf-05", "chi-square-ackf-01", f"double-threshold {POOL_OF_MISSIONS}", RULES, "cooperative")
METRICS = ("accuracy", "precision", "recall", "fpr", "fnr")
SHARES = np.linspace(0.5, 99.5, 100)


def of_missions(result: Result) -> tuple[Figure, ...]:
    """The figures of one condition."""
    key = f"e_{result.condition.data}_{result.condition.words.lower().replace('.', '')}"
    where = f"{result.condition.data}, {result.condition.words}"
    return (
        *(_flags(f"{key}_flags{j + 1}", f"{where}: ranges to leader {j + 1}", result, j) for j in range(2)),
        _bars(f"{key}_scores", f"{where}: detection of anomalies", result),
        _way(f"{key}_position", f"{where}: position error", result),
        _shares(f"{key}_cdf", f"{where}: distribution of the position error", result),
    )


def _flags(name: str, title: str, result: Result, j: int) -> Figure:
    """The paper's figures 13 to 15."""
    case = result.case
    came = ~np.isnan(case.error[:, j]) & case.judged
    error = np.abs(case.error[came, j])
    data: list[Json] = [
        {"type": "scatter", "mode": "lines", "name": "error [m]", "x": _short(case.log.time[came]), "y": _short(error)}
    ]
    data += [_marks(result.shown[method], case, came, j, method, i) for i, method in enumerate(SHOWN)]
    limit: Json = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": WRONG_M, "y1": WRONG_M}
    layout: Json = {
        "xaxis": {"title": {"text": "time [s]"}},
        "yaxis": {"title": {"text": "error of the range [m]"}},
        "shapes": [limit | {"line": {"dash": "dot"}}],
        "height": 420,
    }
    caption = (
        f"The paper's figures 13 to 15 on the first mission: an error above {WRONG_M:g} m is an anomaly; marks below "
        "the axis: ranges flagged by each method."
    )
    return Figure(name, title, caption, {"data": data, "layout": layout})


def _marks(run: Flown, case: Scenario, came: Bool[np.ndarray, " T"], j: int, method: str, line: int) -> Json:
    at = case.log.time[came & run.flagged[:, j]]
    mark: Json = {"symbol": "line-ns-open", "size": 9}
    height = [-2.5 * (line + 1)] * len(at)
    return {"type": "scatter", "mode": "markers", "name": method, "x": _short(at), "y": height, "marker": mark}


def _bars(name: str, title: str, result: Result) -> Figure:
    """The paper's figure 16."""
    data: list[Json] = []
    for method in SHOWN:
        plain, _, words = method.partition(" ")
        condition = f"{result.condition.words} {words}".strip() + " as-printed"
        shares = [result.numbers.mean(condition, plain, metric) for metric in METRICS]
        data.append({"type": "bar", "name": method, "x": list(METRICS), "y": [round(share, 4) for share in shares]})
    caption = "The paper's figure 16: means over the missions, with each method's own limits."
    layout: Json = {"barmode": "group", "yaxis": {"range": [0, 1]}}
    return Figure(name, title, caption, {"data": data, "layout": layout})


def _way(name: str, title: str, result: Result) -> Figure:
    """The paper's figure 18."""
    data = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": method,
            "x": _short(result.case.log.time),
            "y": _short(result.shown[method].off_m),
        }
        for method in ("ungated-ackf", *SHOWN)
    ]
    learned: Json = {"type": "line", "yref": "paper", "y0": 0, "y1": 1, "x0": TRAINED_S, "x1": TRAINED_S}
    layout: Json = {
        "xaxis": {"title": {"text": "time [s]"}},
        "yaxis": {"title": {"text": "error of the position [m]"}},
        "shapes": [learned | {"line": {"dash": "dash"}}],
    }
    caption = "The paper's figures 17 and 18 on the first mission; the test part begins at the dashed line."
    return Figure(name, title, caption, {"data": data, "layout": layout})


def _shares(name: str, title: str, result: Result) -> Figure:
    """The paper's figure 19."""
    data = []
    for method in ("ungated-ackf", *SHOWN):
        at = np.percentile(result.off_m[method], SHARES)
        data.append({"type": "scatter", "mode": "lines", "name": method, "x": _short(at), "y": _short(SHARES / 100)})
    layout: Json = {
        "xaxis": {"title": {"text": "error of the position [m]"}, "type": "log"},
        "yaxis": {"title": {"text": "share of the time"}},
    }
    return Figure(name, title, "The paper's figure 19, over all missions.", {"data": data, "layout": layout})


def _short(x: Float[np.ndarray, " n"] | Sequence[float]) -> list[float]:
    return [round(float(v), 3) for v in x]
