"""A figure of the report page: rows of plots, one above the other, on one time axis.

It is Plotly JSON with two additions. A colour is the name of a CSS variable, so that all colours stand in the style
sheet. An array is stored as differences from its first value, in single precision and base64. page.js fills in both,
draws only as many points as a screen can show, and fits each y axis to what is in view.
"""

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from sensorfault.report.page_lines import Span

Json = dict[str, Any]
HEAD, FOOT, GAP = 4, 34, 24  # pixels above the first row, below the last, and above each row for its label


@dataclass(frozen=True)
class Mark:
    """A span of time to be marked in a row. `label` is drawn at its upper left."""

    span: Span
    color: str
    label: str = ""
    line: str = ""  # "solid" or "dot": a line along the top instead of a shade


@dataclass(frozen=True)
class Row:
    """One plot: traces without their axes, and marks. `label` is HTML, with names escaped."""

    label: str
    traces: Sequence[Json]
    marks: Sequence[Mark] = ()
    log: bool = False


def packed(array: Float[np.ndarray, " K"]) -> Json:
    """An array for the page, in half its size; a longitude keeps millimetres."""
    finite = array[np.isfinite(array)]
    base = float(finite[0]) if finite.size else 0.0
    return {"f4": b64encode((array - base).astype("<f4").tobytes()).decode(), "from": base}


def _mark(mark: Mark, axis: str) -> Json:
    shape: Json = {"xref": "x", "yref": f"{axis} domain", "x0": mark.span[0], "x1": mark.span[1], "layer": "below"}
    if mark.line:
        pen = {"color": mark.color, "width": 2.5, "dash": mark.line}
        return {**shape, "type": "line", "y0": 1, "y1": 1, "layer": "above", "line": pen}
    font = {"size": 10, "color": "--fault"}
    return {
        **shape,
        "type": "rect",
        "y0": 0,
        "y1": 1,
        "fillcolor": mark.color,
        "line": {"color": mark.color, "width": 1},  # so that one faulty sample among thousands is visible
        "label": {"text": mark.label, "textposition": "top left", "font": font, "padding": 2},
    }


def time_axis(span: Span) -> Json:
    """The time axis of all figures."""
    return {
        "range": list(span),
        "title": {"text": "time [s]", "standoff": 4, "font": {"size": 11}},
        "gridcolor": "--grid",
        "zeroline": False,
        "unifiedhovertitle": {"text": "%{x:.3f} s"},
        "showspikes": True,
        "spikemode": "across",
        "spikethickness": 1,
        "spikedash": "solid",
        "spikecolor": "--muted",
    }


def stacked(rows: Sequence[Row], span: Span, height: int) -> Json:
    """Rows from top to bottom, each `height` pixels high."""
    whole = len(rows) * (height + GAP)
    layout: Json = {"height": whole + HEAD + FOOT, "xaxis": time_axis(span), "shapes": [], "annotations": []}
    data: list[Json] = []
    for i, row in enumerate(rows):
        axis = f"y{i + 1}" if i else "y"
        bottom = 1 - (i + 1) * (height + GAP) / whole
        top = bottom + height / whole
        layout["yaxis" + axis[1:]] = {
            "domain": [max(0.0, bottom), top],
            "type": "log" if row.log else "linear",
            "fixedrange": True,
            "gridcolor": "--grid",
            "zeroline": False,
            "nticks": 4,
        }
        data += [{**trace, "xaxis": "x", "yaxis": axis} for trace in row.traces]
        layout["shapes"] += [_mark(mark, axis) for mark in row.marks]
        layout["annotations"].append(
            {
                "text": row.label,
                "x": 0,
                "y": top,
                "xref": "paper",
                "yref": "paper",
                "xanchor": "left",
                "yanchor": "bottom",
                "showarrow": False,
            }
        )
    layout["xaxis"]["anchor"] = axis if rows else "y"
    return {"data": data, "layout": layout, "fit": True}
