"""Figures of the learned rules: memberships, surfaces, features and learning curves."""

from collections.abc import Sequence

import jax
import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Anfis
from sensorfault.numerics.innovation import FEATURES
from sensorfault.training.labelled import Labelled
from sensorfault_studies.findings import Figure, Json, Row

SYMBOLS = ("|r|", "M²", "R*")
LOGARITHMS = {"M²": (-2, 3), "R*": (0.8, 3.8)}  # range of the axis in powers of ten
PAIRS = ((0, 1), (0, 2), (1, 2))
CORNER = (-1.6, -1.6, 1.0)  # viewpoint with most of the training points in front
FINE = 31  # points along each side of a surface
COLORS = ("#2a6fb0", "#c0562f", "#3d8a4d", "#8a5fa8")


def memberships(name: str, title: str, before: Anfis, after: Anfis) -> Figure:
    """The paper's figure 11: membership functions over each scaled feature, before training and after."""
    x = np.linspace(0, 1, 101)
    data: list[Json] = []
    for model, dash in ((before, "dot"), (after, "solid")):
        premises = jax.tree.map(np.asarray, model.premises)
        grades = np.exp(premises.grades(np.tile(x[:, None], (1, len(FEATURES)))))
        for p, i in enumerate(premises.inputs):
            color = COLORS[sum(other == i for other in premises.inputs[:p]) % len(COLORS)]
            line: Json = {"dash": dash, "color": color}
            data.append(
                _line("", x, grades[:, p]) | {"xaxis": f"x{i + 1 if i else ''}", "line": line, "showlegend": False}
            )
    for dash, word in (("dot", "before training"), ("solid", "after training")):
        data.append(_line(word, x[:1], x[:1] * np.nan) | {"line": {"dash": dash, "color": COLORS[0]}})
    layout: Json = {"yaxis": {"title": {"text": "membership"}, "range": [0, 1.03]}} | _beside("xaxis")
    caption = "The paper's figure 11; features are scaled by the training range."
    return Figure(name, title, caption, {"data": data, "layout": layout})


def surface(name: str, title: str, model: Anfis, seen: Labelled) -> Figure:
    """The paper's figure 12: predicted error over two scaled features, the third at its training median."""
    result = jax.tree.map(np.asarray, model)
    unit = result.unit
    rows, side = np.asarray(unit(seen.features)), np.linspace(0, 1, FINE)
    highest = 1.2 * float(seen.target.max())
    data: list[Json] = []
    layout: Json = {"height": 420}
    for s, (i, j) in enumerate(PAIRS):
        scene = f"scene{s + 1 if s else ''}"
        x = np.tile(np.median(rows, axis=0), (FINE, FINE, 1))
        x[..., i], x[..., j] = side[None], side[:, None]
        size = x * unit.span + unit.low
        z = result(np.exp(size) if unit.log else size)
        data.append(
            {"type": "surface", "scene": scene, "x": _short(side), "y": _short(side), "showscale": False}
            | {"z": np.clip(z, 0, highest).round(2).tolist(), "colorscale": "Viridis", "opacity": 0.85}
        )
        points: Json = {"x": _short(rows[:, i]), "y": _short(rows[:, j]), "z": _short(seen.target)}
        mark: Json = {"size": 2, "color": COLORS[1]}
        data.append(
            {"type": "scatter3d", "mode": "markers", "scene": scene, "marker": mark, "name": "training"}
            | points
            | {"showlegend": not s}
        )
        layout[scene] = {
            "domain": {"x": [s / 3, (s + 0.96) / 3]},
            "xaxis": {"title": {"text": SYMBOLS[i]}},
            "yaxis": {"title": {"text": SYMBOLS[j]}},
            "zaxis": {"title": {"text": "[m]"}, "range": [0, highest]},
            "camera": {"eye": dict(zip("xyz", CORNER, strict=True))},
        }
    caption = (
        "The paper's figure 12; points: training data. R* is R max(1, M²), and M² grows with |r|, so the points lie "
        "near one line; away from it the surface is extrapolated."
    )
    return Figure(name, title, caption, {"data": data, "layout": layout})


def features(
    name: str,
    title: str,
    time: Float[np.ndarray, " N"],
    error: Float[np.ndarray, " N"],
    plain: Float[np.ndarray, "N 3"],
    adaptive: Float[np.ndarray, "N 3"],
) -> Figure:
    """The paper's figure 10: |error| and the features of its innovation, in the plain and in the adaptive filter.

    `error` [m]; features as numerics/innovation.py has them, of the same ranges.
    """
    data: list[Json] = [_line("|error|", time, np.abs(error)) | {"line": {"dash": "dot", "color": COLORS[2]}}]
    layout: Json = {"xaxis": {"title": {"text": "time [s]"}, "anchor": "y3"}, "height": 560}
    for i, symbol in enumerate(SYMBOLS):
        axis = str(i + 1) if i else ""
        for word, seen, color in (("CKF", plain, COLORS[0]), ("ACKF", adaptive, COLORS[1])):
            line = _line(word, time, seen[:, i]) | {"yaxis": f"y{axis}", "line": {"color": color}}
            data.append(line | {"legendgroup": word, "showlegend": not i})
        scale: Json = {"type": "log", "range": LOGARITHMS[symbol]} if i else {}
        domain = [0.69 - 0.345 * i, 1.0 - 0.345 * i]
        unit = " [m]" if i == 0 else " [m²]" if i == 2 else ""
        layout[f"yaxis{axis}"] = {"title": {"text": symbol + unit}, "domain": domain} | scale
    caption = "The paper's figure 10: after a fault the innovations of the adaptive filter are soon small again."
    return Figure(name, title, caption, {"data": data, "layout": layout})


def learning(name: str, title: str, rows: Sequence[Row], metric: str = "accuracy") -> Figure:
    """Learning curves, one line for each method, from rows whose condition ends in n25, n50, and so on."""
    mine = [row for row in rows if row.metric == metric and _rows_of(row)]
    sizes = sorted({_rows_of(row) for row in mine})
    data: list[Json] = []
    for key in dict.fromkeys((row.method, _variant(row)) for row in mine):
        of = sorted((row for row in mine if (row.method, _variant(row)) == key), key=_rows_of)
        line = _line(
            " ".join(key).strip(), np.array([float(_rows_of(row)) for row in of]), np.array([r.value for r in of])
        )
        bars: Json = {"type": "data", "array": [round(row.spread or 0.0, 4) for row in of]}
        data.append(line | {"mode": "lines+markers", "error_y": bars})
    layout: Json = {
        "xaxis": {"title": {"text": "training ranges"}, "type": "log"} | {"tickvals": sizes, "ticktext": sizes},
        "yaxis": {"title": {"text": metric}},
    }
    caption = "Random parts of the training data, tested on the same ranges; bars: standard deviation over the draws."
    return Figure(name, title, caption, {"data": data, "layout": layout})


def _rows_of(row: Row) -> int:
    last = row.condition.split()[-1] if row.condition else ""
    return int(last[1:]) if last[:1] == "n" and last[1:].isdigit() else 0


def _variant(row: Row) -> str:
    return " ".join(row.condition.split()[:-1])


def _beside(axis: str) -> Json:
    """Three axes side by side, one for each feature."""
    return {
        f"{axis}{i + 1 if i else ''}": {"title": {"text": FEATURES[i]}, "domain": [i / 3, (i + 0.9) / 3]}
        for i in range(len(FEATURES))
    }


def _line(name: str, x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Json:
    shown = [round(float(v), 4) if np.isfinite(v) else None for v in y]
    return {"type": "scatter", "mode": "lines", "name": name, "x": [round(float(v), 3) for v in x], "y": shown}


def _short(x: Float[np.ndarray, " n"]) -> list[float]:
    return [round(float(v), 4) for v in x]
