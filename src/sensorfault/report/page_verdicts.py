"""The verdict on each sensor over time, by height and colour: ok thin, unknown hatched, fault high."""

from collections.abc import Sequence
from html import escape

from sensorfault.core.times import clock
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN, VERDICTS
from sensorfault.faults.fault import Fault
from sensorfault.report.page_figure import FOOT, Json, time_axis
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_words import found

LANE = 56  # pixels a sensor: its name, the injected faults, the band
LOOKS: dict[int, Json] = {
    OK: {"width": 0.12, "marker": {"color": "--ok"}},
    UNKNOWN: {
        "width": 0.28,
        "marker": {
            "color": "--back",
            "line": {"width": 0},
            "pattern": {"shape": "/", "fgcolor": "--unknown", "size": 5, "solidity": 0.45},
        },
    },
    FAULT: {"width": 0.44, "marker": {"color": "--fault", "line": {"color": "--fault", "width": 1}}},
}

Bar = tuple[float, float, int, str]  # from, to [s], lane, text


def _bars(sketch: Sketch) -> list[tuple[int, Bar]]:
    bars = []
    for place, (name, lane) in enumerate(sketch.lanes):
        for low, high, code in zip(lane.start, [*lane.start[1:], sketch.span[1]], lane.verdict, strict=True):
            text = f"{escape(name)}: {VERDICTS[code]}, {clock(low)} to {clock(high)}"
            bars.append((code, (low, high, place, text)))
    return bars


def _trace(bars: Sequence[Bar], look: Json, lift: float) -> Json:
    return {
        "type": "bar",
        "orientation": "h",
        "base": [low for low, _, _, _ in bars],
        "x": [high - low for low, high, _, _ in bars],
        "y": [lane + lift for _, _, lane, _ in bars],
        "hovertext": [text for _, _, _, text in bars],
        "hoverinfo": "text",
        **look,
    }


def _truth(sketch: Sketch, truth: Sequence[Fault]) -> list[Json]:
    """The injected faults as thin lines above the bands; a missed fault is hollow, with a cross."""
    lane = {name: i for i, (name, _) in enumerate(sketch.lanes)}
    hits: list[Bar] = []
    misses: list[Bar] = []
    for f in truth:
        if f.sensor not in lane:
            continue
        hit = found(f, sketch.events)
        text = (
            f"injected {escape(f.kind)} in {escape(f.sensor)} {escape(f.channel or '')}, {'found' if hit else 'missed'}"
        )
        (hits if hit else misses).append((f.start_s, f.end_s, lane[f.sensor], text))
    pen = {"color": "--truth", "width": 1.5}
    cross = {
        "type": "scatter",
        "mode": "markers",
        "x": [(low + high) / 2 for low, high, _, _ in misses],
        "y": [place - 0.08 for _, _, place, _ in misses],
        "marker": {"symbol": "x-thin", "size": 9, "line": pen},
        "hovertext": [text for _, _, _, text in misses],
        "hoverinfo": "text",
    }
    found_ones = _trace(hits, {"width": 0.07, "marker": {"color": "--truth", "line": pen}}, -0.08)
    missed_ones = _trace(misses, {"width": 0.07, "marker": {"color": "--back", "line": pen}}, -0.08)
    return [found_ones, missed_ones, cross]


def _label(lane: int, name: str) -> Json:
    """The sensor's name above the left end of its band."""
    place = {"x": 0, "y": lane - 0.18, "xref": "paper", "yref": "y", "xanchor": "left", "yanchor": "bottom"}
    return {"text": f"<b>{escape(name)}</b>", "showarrow": False, "borderpad": 0, **place}


def verdicts(sketch: Sketch, truth: Sequence[Fault] = ()) -> Json:
    """The figure of verdicts: one band for each sensor, in the order of the log."""
    bars = _bars(sketch)
    data = [_trace([bar for code, bar in bars if code == verdict], look, 0.24) for verdict, look in LOOKS.items()]
    names = [_label(i, name) for i, (name, _) in enumerate(sketch.lanes)]
    layout = {
        "height": LANE * max(1, len(names)) + FOOT + 4,
        "barmode": "overlay",
        "hovermode": "closest",
        "annotations": names,
        "xaxis": {**time_axis(sketch.span), "showspikes": False},
        "yaxis": {
            "range": [len(names) - 0.5, -0.5],
            "showticklabels": False,
            "fixedrange": True,
            "showgrid": False,
            "zeroline": False,
        },
    }
    return {"data": data + (_truth(sketch, truth) if truth else []), "layout": layout, "fit": False}
