"""What each test said: its score against its limit."""

from html import escape

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.detection import Detection, Trace
from sensorfault.evaluation.page_figure import Json, Row, packed, stacked
from sensorfault.evaluation.page_lines import line
from sensorfault.evaluation.page_marks import at, kept, shades, whole
from sensorfault.events import Event
from sensorfault.model import MOTION, TOGETHER


def spans_much(score: Float[np.ndarray, " T"]) -> bool:
    """Whether a score needs a logarithmic axis: positive, and its peak far above the usual."""
    finite = score[np.isfinite(score)]
    return finite.size > 0 and bool(finite.min() > 0 and finite.max() > 30 * np.median(finite))


def _concerns(detection: Detection, trace: Trace, event: Event) -> bool:
    if MOTION in (trace.channel, event.subject):
        return trace.channel == event.subject
    accused = None if trace.channel is None else trace.channel.split(TOGETHER)
    tested = [c for c in detection.log.channels if accused is None or c.path in accused or c.name in accused]
    return event.sensor is None or any(at(event, channel) for channel in tested)


def _row(detection: Detection, trace: Trace, keep: Bool[np.ndarray, " T"], points: int) -> Row:
    parts = (
        (trace.limit, "limit", {"color": "--fault", "width": 1.2, "dash": "5px,3px"}, points // 4),
        (trace.score, "score", {"color": "--score", "width": 1}, points),
    )
    traces = []
    for value, name, pen, most in parts:
        x, y = line(detection.log.time, np.where(np.isfinite(value), value, np.nan), keep, most)
        hover = f"{name} %{{y:.4~g}}<extra></extra>"
        pair = {"x": packed(x), "y": packed(y), "name": name, "line": pen, "hovertemplate": hover}
        traces.append(
            {"type": "scatter", "mode": "lines" if x.size > 200 else "lines+markers", "marker": {"size": 3}, **pair}
        )
    label = f"<b>{escape(trace.name)}</b> {escape(trace.channel or 'all channels together')}"
    return Row(
        label, traces, shades(detection, lambda event: _concerns(detection, trace, event)), log=spans_much(trace.score)
    )


def scores(detection: Detection, points: int) -> Json:
    """One row a test."""
    keep = kept(detection, points)
    rows = [_row(detection, trace, keep, points) for trace in detection.traces]
    return stacked(rows, whole(detection.log), 72)
