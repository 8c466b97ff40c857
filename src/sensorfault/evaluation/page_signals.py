"""What each sensor said, and what was put in its place."""

from collections.abc import Sequence
from html import escape

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.detection import Detection
from sensorfault.evaluation.page_figure import Json, Row, packed, stacked
from sensorfault.evaluation.page_lines import line
from sensorfault.evaluation.page_marks import at, injected, kept, shades, whole
from sensorfault.evaluation.page_words import SILENCE_ONLY, blind
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.types import FAULT


def stale(log: Log, column: int) -> Bool[np.ndarray, " T"]:
    """Where a value is held for longer than the sensor's own period: the last measurement, said again and again."""
    fresh = log.fresh[:, column]
    last: Float[np.ndarray, " T"] = np.maximum.accumulate(np.where(fresh, log.time, -np.inf))
    period = next(s.period_s for s in log.sensors if s.name == log.channels[column].sensor)
    held: Bool[np.ndarray, " T"] = ~fresh & (log.time - last > 2.5 * np.fmax(period, log.period_s))
    return held


def replaced(detection: Detection, column: int) -> Float[np.ndarray, " T"]:
    """The stand-in where the channel was faulty or silent, with one sample either side to tie it to the signal."""
    value, repaired = detection.log.value[:, column], detection.repaired[:, column]
    mask = (detection.channel[:, column] == FAULT) | (~np.isfinite(value) & np.isfinite(repaired))
    wide = mask.copy()
    wide[:-1] |= mask[1:]
    wide[1:] |= mask[:-1]
    stand_in: Float[np.ndarray, " T"] = np.where(wide, repaired, np.nan)
    return stand_in


def digits(value: Float[np.ndarray, " K"]) -> int:
    """Digits that tell a thousandth of the signal's span from nothing: more for a longitude than for a rate."""
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


def _row(detection: Detection, column: int, keep: Bool[np.ndarray, " T"], points: int, truth: Sequence[Fault]) -> Row:
    log = detection.log
    channel = log.channels[column]
    name, unit = escape(channel.name), escape(channel.unit)
    value, old = from_si(log.value[:, column], channel.unit), stale(log, column)
    stand_in = from_si(replaced(detection, column), channel.unit)
    mode = "lines" if np.isfinite(value).sum() > 200 else "lines+markers"
    parts = (
        (np.where(old, np.nan, value), name, {"color": "--signal", "width": 1.2}),
        (np.where(old, value, np.nan), f"{name}, held", {"color": "--signal", "width": 0.6}),
        (stand_in, f"{name}, stand-in", {"color": "--standin", "width": 1.6, "dash": "4px,3px"}),
    )
    traces = [
        _trace(*line(log.time, part, keep, points), label, unit, mode, pen)
        for part, label, pen in parts
        if np.isfinite(part).any()
    ]
    marks = shades(detection, lambda event: at(event, channel)) + injected(detection, channel, truth)
    text = f"<b>{name}</b>{f' [{unit}]' if unit else ''}"
    if not detection.watched[column] and channel.sensor not in blind(detection):
        text += f" not judged, {SILENCE_ONLY}"
    return Row(text if traces else f"{text} never spoke", traces, marks)


def signals(detection: Detection, sensor: str, truth: Sequence[Fault], points: int) -> Json:
    """One row a channel, in the channel's own unit."""
    columns, keep = detection.log.of(sensor), kept(detection, points)
    rows = [_row(detection, column, keep, points, truth) for column in columns]
    return stacked(rows, whole(detection.log), 90 if len(columns) <= 6 else 60)
