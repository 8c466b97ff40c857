"""A detection as one Plotly figure, of the same parts as the report page."""

from collections.abc import Sequence
from dataclasses import replace
from html import escape
from typing import Any

from sensorfault.core.expect import DETECTION, FAULTS, expect, expect_all, wrong
from sensorfault.core.extras import require
from sensorfault.faults.fault import Fault
from sensorfault.report.page_figure import FOOT, HEAD, Json, stacked
from sensorfault.report.page_scores import score_rows
from sensorfault.report.page_signals import rows_of
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_verdicts import verdicts
from sensorfault.report.plot_dress import dress
from sensorfault.runtime.result import Detection

ROW = 90  # pixels a signal or test
POINTS = 60_000  # of all lines together: what a notebook draws at once


def plot(
    detection: Detection,
    truth: Sequence[Fault] = (),
    dark: bool = False,
    sensors: Sequence[str] | None = None,
    scores: bool = True,
) -> Any:
    """Draw a detection: a band of verdicts a sensor, the signals with faults shaded and stand-ins, scores and limits.

    All on one time axis [s]. A signal has its channel's own unit, a score its statistic's. Long lines are thinned: the
    extremes stay, and all there is around an event.

    Args:
        detection: what `detect` returned; at least one tick.
        truth: injected faults, to be marked beside those found.
        dark: colours for a dark background; the background itself is left transparent.
        sensors: draw the signals of these sensors only; None: of all.
        scores: also draw the tests.

    Returns:
        A `plotly.graph_objects.Figure`.

    Raises:
        TypeError: something else than a detection, than faults, or than a list of names.
        LogError: no such sensor.
        MissingLibrary: plotly is not installed.
    """
    expect(detection, Detection, "plot: detection", DETECTION)
    expect_all(truth, Fault, "plot: truth", FAULTS)
    if isinstance(sensors, str):
        raise wrong(sensors, "plot: sensors", "a list of sensor names")
    sketch = Sketch.of(detection.received, POINTS)
    names = [sensor.name for sensor in sketch.log.sensors] if sensors is None else list(sensors)
    rows = [replace(row, label=f"{escape(name)} {row.label}") for name in names for row in rows_of(sketch, name, truth)]
    rows += score_rows(sketch) if scores else []
    return _figure(_above(verdicts(sketch, truth), stacked(rows, sketch.span, ROW)), dark)


def _above(bands: Json, rows: Json) -> Json:
    """The bands of verdicts over the rows, on one time axis."""
    high = bands["layout"]["height"] - FOOT
    whole = rows["layout"]["height"] - HEAD - FOOT
    share = whole / (high + whole)
    layout = {**rows["layout"], "height": high + rows["layout"]["height"], "barmode": "overlay", "hovermode": "closest"}
    for name in [name for name in layout if name.startswith("yaxis")]:
        layout[name] = {**layout[name], "domain": [edge * share for edge in layout[name]["domain"]]}
    notes = [{**note, "y": note["y"] * share} for note in rows["layout"]["annotations"]]
    lane = {**bands["layout"]["yaxis"], "domain": [share, 1.0]}
    labels = [{**note, "yref": "y99"} for note in bands["layout"]["annotations"]]
    data = [{**trace, "xaxis": "x", "yaxis": "y99"} for trace in bands["data"]]
    if not rows["data"]:
        layout["xaxis"] = {**layout["xaxis"], "anchor": "y99"}
    layout |= {"yaxis99": lane, "annotations": [*notes, *labels]}
    return {"data": [*rows["data"], *data], "layout": layout}


def _figure(figure: Json, dark: bool) -> Any:
    require("a plot", "plotly")
    import plotly.graph_objects as go

    return go.Figure(dress(figure, dark))
