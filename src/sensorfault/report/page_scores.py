"""Each test over time: its score and its limit."""

from html import escape

from sensorfault.events.event import Event
from sensorfault.report.page_figure import Json, Row, packed, stacked
from sensorfault.report.page_marks import at, shades
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_strokes import Tested
from sensorfault.runtime.model import MOTION, TOGETHER


def _concerns(sketch: Sketch, test: Tested, event: Event) -> bool:
    if MOTION in (test.channel, event.subject):
        return test.channel == event.subject
    accused = None if test.channel is None else test.channel.split(TOGETHER)
    tested = [c for c in sketch.log.channels if accused is None or c.path in accused or c.name in accused]
    return event.sensor is None or any(at(event, channel) for channel in tested)


def _row(sketch: Sketch, test: Tested) -> Row:
    parts = (
        (test.limit, "limit", {"color": "--fault", "width": 1.2, "dash": "5px,3px"}),
        (test.score, "score", {"color": "--score", "width": 1}),
    )
    traces = []
    for stroke, name, pen in parts:
        x, hover = stroke.x, f"{name} %{{y:.4~g}}<extra></extra>"
        pair = {"x": packed(x), "y": packed(stroke.y), "name": name, "line": pen, "hovertemplate": hover}
        traces.append(
            {"type": "scatter", "mode": "lines" if x.size > 200 else "lines+markers", "marker": {"size": 3}, **pair}
        )
    label = f"<b>{escape(test.name)}</b> {escape(test.channel or 'all channels together')}"
    return Row(label, traces, shades(sketch, lambda event: _concerns(sketch, test, event)), log=test.spans_much)


def score_rows(sketch: Sketch) -> list[Row]:
    """One row a test."""
    return [_row(sketch, test) for test in sketch.tests.values()]


def scores(sketch: Sketch) -> Json:
    """The figure of all tests."""
    return stacked(score_rows(sketch), sketch.span, 72)
