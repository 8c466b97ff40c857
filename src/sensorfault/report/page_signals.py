"""The signals: what each sensor measured, and the stand-in where it was faulty."""

from collections.abc import Sequence
from html import escape

import numpy as np
from jaxtyping import Float

from sensorfault.faults.fault import Fault
from sensorfault.report.page_figure import Json, Row, packed, stacked
from sensorfault.report.page_marks import at, injected, shades
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_words import DROPOUTS_ONLY, blind


def digits(value: Float[np.ndarray, " K"]) -> int:
    """How many digits show a thousandth of the signal's span: more for a longitude than for a rate."""
    finite = value[np.isfinite(value)]
    span = float(np.ptp(finite)) if finite.size else 0.0
    if span == 0.0:
        return 5
    return int(np.clip(np.ceil(np.log10(np.abs(finite).max() / span)) + 4, 4, 12))


def _trace(x: Float[np.ndarray, " K"], y: Float[np.ndarray, " K"], name: str, unit: str, mode: str, pen: Json) -> Json:
    return {
        "type": "scatter",
        "mode": mode,
        "x": packed(x),
        "y": packed(y),
        "name": name,
        "line": pen,
        "marker": {"size": 3, "color": pen["color"]},
        "hovertemplate": f"{name} %{{y:.{digits(y)}~g}} {unit}<extra></extra>",
    }


def _row(sketch: Sketch, column: int, truth: Sequence[Fault]) -> Row:
    channel, drawn = sketch.log.channels[column], sketch.channels[column]
    name, unit = escape(channel.name), escape(channel.unit)
    mode = "lines" if drawn.measured.count + drawn.held.count > 200 else "lines+markers"
    parts = (
        (drawn.measured, name, {"color": "--signal", "width": 1.2}),
        (drawn.held, f"{name}, held", {"color": "--signal", "width": 0.6}),
        (drawn.stand_in, f"{name}, stand-in", {"color": "--standin", "width": 1.6, "dash": "4px,3px"}),
    )
    traces = [_trace(stroke.x, stroke.y, label, unit, mode, pen) for stroke, label, pen in parts if stroke.count]
    marks = shades(sketch, lambda event: at(event, channel)) + injected(sketch, channel, truth)
    text = f"<b>{name}</b>{f' [{unit}]' if unit else ''}"
    if not sketch.watched[column] and channel.sensor not in blind(sketch):
        text += f", {DROPOUTS_ONLY}"
    return Row(text if traces else f"{text} has no data", traces, marks)


def rows_of(sketch: Sketch, sensor: str, truth: Sequence[Fault]) -> list[Row]:
    """One row a channel of a sensor, in the channel's own unit."""
    return [_row(sketch, column, truth) for column in sketch.log.of(sensor)]


def signals(sketch: Sketch, sensor: str, truth: Sequence[Fault]) -> Json:
    """The figure of one sensor."""
    rows = rows_of(sketch, sensor, truth)
    return stacked(rows, sketch.span, 90 if len(rows) <= 6 else 60)
