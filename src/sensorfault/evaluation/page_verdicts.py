"""The verdict on each sensor over time, told by height and colour: ok thin, unknown hatched, fault high."""

from collections.abc import Sequence
from html import escape

import numpy as np
from jaxtyping import Int8

from sensorfault.detection import Detection
from sensorfault.evaluation.page_figure import FOOT, Json, time_axis
from sensorfault.evaluation.page_lines import runs
from sensorfault.evaluation.page_marks import whole
from sensorfault.evaluation.page_words import MOTION, clock, found
from sensorfault.faults.fault import Fault
from sensorfault.types import FAULT, OK, UNKNOWN, VERDICTS

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


def lanes(detection: Detection) -> list[tuple[str, Int8[np.ndarray, " T"]]]:
    """Name and verdicts of every sensor; of the whole, where it was faulty and nobody could be named; of the motion."""
    named = [(sensor.name, detection.sensor[:, i]) for i, sensor in enumerate(detection.log.sensors)]
    nameless = (detection.sample == FAULT) & (detection.sensor.max(axis=1, initial=OK) < FAULT)
    if nameless.any():
        named.append(("unknown which", np.where(nameless, FAULT, OK).astype(np.int8)))
    if (detection.motion != UNKNOWN).any():
        named.append((MOTION, detection.motion))
    return named


def _bars(detection: Detection) -> list[tuple[int, Bar]]:
    log = detection.log
    bars = []
    for lane, (name, verdict) in enumerate(lanes(detection)):
        start, value = runs(verdict)
        begin = log.time[start]
        end = np.append(begin[1:], whole(log)[1])
        for low, high, code in zip(begin.tolist(), end.tolist(), value.tolist(), strict=True):
            text = f"{escape(name)}: {VERDICTS[code]}, {clock(low)} to {clock(high)}"
            bars.append((code, (low, high, lane, text)))
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


def _truth(detection: Detection, truth: Sequence[Fault]) -> list[Json]:
    """The injected faults as thin lines above the bands; a missed one hollow, with a cross."""
    lane = {name: i for i, (name, _) in enumerate(lanes(detection))}
    hits: list[Bar] = []
    misses: list[Bar] = []
    for f in truth:
        if f.sensor not in lane:
            continue
        hit = found(f, detection.events)
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


def verdicts(detection: Detection, truth: Sequence[Fault] = ()) -> Json:
    """One band a sensor, top to bottom in the order of the log."""
    bars = _bars(detection)
    data = [_trace([bar for code, bar in bars if code == verdict], look, 0.24) for verdict, look in LOOKS.items()]
    names = [_label(i, name) for i, (name, _) in enumerate(lanes(detection))]
    layout = {
        "height": LANE * max(1, len(names)) + FOOT + 4,
        "barmode": "overlay",
        "hovermode": "closest",
        "annotations": names,
        "xaxis": {**time_axis(whole(detection.log)), "showspikes": False},
        "yaxis": {
            "range": [len(names) - 0.5, -0.5],
            "showticklabels": False,
            "fixedrange": True,
            "showgrid": False,
            "zeroline": False,
        },
    }
    return {"data": data + (_truth(detection, truth) if truth else []), "layout": layout, "fit": False}
