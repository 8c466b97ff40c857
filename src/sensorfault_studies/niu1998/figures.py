"""Figures 3 to 6 of the paper, detection of slow drifts, and isolation on the real arm."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from sensorfault_studies.findings import Figure, Json, Row
from sensorfault_studies.niu1998.drifts import AT_RATE, NAMES, Drifts
from sensorfault_studies.niu1998.fleet import Result
from sensorfault_studies.niu1998.joints import PATHS
from sensorfault_studies.niu1998.rivals import NETWORK, SCRATCH
from sensorfault_studies.niu1998.run import COLUMNS, ONSET, WITHIN

PRINTED = "as-printed"
UNITS = {"y2": "rad/s", "y4": "rad"}
NUMBERS = {"y2": (3, 4), "y4": (5, 6)}  # of the paper's figures
NETWORKS = {f"{PRINTED} {NETWORK}": "trained before", f"{PRINTED} {SCRATCH} {NETWORK}": "from scratch"}


def of_the_run(result: Drifts) -> tuple[Figure, ...]:
    """Prediction and measurement, residual and threshold of y2 and y4 in the first run."""
    return tuple(figure for i in range(2) for figure in (_prediction(result, i), _residual(result, i)))


def _prediction(result: Drifts, i: int) -> Figure:
    y, column = NAMES[i], COLUMNS[i]
    lines = [_line(f"expected, {name}", _expected(result.shown[key][0], column)) for key, name in NETWORKS.items()]
    value = result.shown[next(iter(NETWORKS))][1][0, :, column]
    plot: Json = {"data": [_line("measured", value), *lines], "layout": _axes(f"{y} [{UNITS[y]}]")}
    caption = (
        f"The paper's figure {NUMBERS[y][0]}: from sample {ONSET} on the sensor drifts by two thresholds a sample; the "
        "networks stop learning and continue on their own predictions."
    )
    return Figure(f"b_prediction_{y}", f"Prediction and measurement of {y}", caption, plot)


def _expected(result: Result, column: int) -> Float[np.ndarray, " T"]:
    """From the second sample on; at the first nothing is known."""
    after = np.arange(result.expected.shape[1]) > 0
    return np.where(after, result.expected[0, :, column], np.nan)


def _residual(result: Drifts, i: int) -> Figure:
    y, column = NAMES[i], COLUMNS[i]
    lines = [_line(f"residual, {name}", result.shown[key][0].score[0, :, column]) for key, name in NETWORKS.items()]
    limit = float(result.shown[next(iter(NETWORKS))][0].limit[column])
    layout = _axes(f"|{y} - expected| [{UNITS[y]}]") | {"yaxis": {"type": "log", "title": {"text": f"[{UNITS[y]}]"}}}
    threshold = _line("threshold", np.full(len(result.shown[next(iter(NETWORKS))][1][0]), limit)) | {
        "line": {"dash": "dot"}
    }
    caption = f"The paper's figure {NUMBERS[y][1]}; gaps are samples that could not be tested."
    plot: Json = {"data": [*lines, threshold], "layout": layout}
    return Figure(f"b_residual_{y}", f"Residual of {y} against its threshold", caption, plot)


def _line(name: str, y: Float[np.ndarray, " T"]) -> Json:
    shown = [round(float(v), 6) if np.isfinite(v) else None for v in y]
    return {"type": "scatter", "mode": "lines", "name": name, "x": list(range(len(y))), "y": shown}


def _axes(title: str) -> Json:
    onset = {"type": "line", "x0": ONSET, "x1": ONSET, "yref": "paper", "y0": 0, "y1": 1, "line": {"dash": "dash"}}
    return {"xaxis": {"title": {"text": "sample"}}, "yaxis": {"title": {"text": title}}, "shapes": [onset]}


def of_slow_drifts(rows: Sequence[Row]) -> tuple[Figure, ...]:
    """Share of drifts detected in time over the rate of the drift, one line for each method."""
    return tuple(_slow(rows, y) for y in NAMES)


def _slow(rows: Sequence[Row], y: str) -> Figure:
    ending = f"{AT_RATE} {y}"
    mine = [row for row in rows if row.condition.endswith(ending) and row.metric == "detection_rate"]
    data: list[Json] = []
    for method, condition in dict.fromkeys((row.method, row.condition) for row in mine):
        of = sorted((row for row in mine if (row.method, row.condition) == (method, condition)), key=_size)
        variant = condition.removeprefix(PRINTED).removesuffix(ending).strip()
        name = f"{method} {variant}".strip()
        x, share = [_size(row) for row in of], [round(row.value, 4) for row in of]
        data.append({"type": "scatter", "mode": "lines+markers", "name": name, "x": x, "y": share})
    layout = {
        "xaxis": {"title": {"text": "drift [thresholds a sample]"}, "type": "log"},
        "yaxis": {"title": {"text": f"detected within {WITHIN} samples"}, "range": [0, 1.02]},
    }
    caption = f"Only {y} drifts; every method raises an alarm before the onset in 5 % of healthy runs."
    return Figure(f"b_slow_{y}", f"Detection of slow drifts of {y}", caption, {"data": data, "layout": layout})


def _size(row: Row) -> float:
    return row.magnitude or 0.0


def of_isolation(accused: Int[np.ndarray, "12 13"]) -> Figure:
    """The sensor isolated by the first alarm, for each faulty sensor."""
    share = accused / np.maximum(accused.sum(axis=1, keepdims=True), 1)
    names = [path.split(".")[0] for path in PATHS]
    heat: Json = {"type": "heatmap", "x": [*names, "none"], "y": names, "z": share.round(3).tolist(), "zmin": 0,
                  "zmax": 1, "colorscale": "Blues", "reversescale": True}  # fmt: skip
    layout = {
        "xaxis": {"title": {"text": "isolated sensor"}},
        "yaxis": {"title": {"text": "faulty sensor"}, "autorange": "reversed"},
        "height": 480,
    }
    caption = (
        f"{NETWORK} on the Schunk arm: spike, offset and frozen of five one-step errors; limits that one healthy "
        "sample in a hundred exceeds on any sensor."
    )
    return Figure("b_isolation", "Isolation on the real arm", caption, {"data": [heat], "layout": layout})
