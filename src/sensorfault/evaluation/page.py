"""The report page: one HTML file that opens anywhere, offline, and asks nobody for anything."""

import json
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

from sensorfault.detection import Detection
from sensorfault.evaluation.page_figure import Json
from sensorfault.evaluation.page_scores import scores
from sensorfault.evaluation.page_signals import signals
from sensorfault.evaluation.page_verdicts import verdicts
from sensorfault.evaluation.page_words import SILENCE_ONLY, blind, event_table, facts, result, sentences, truth_table
from sensorfault.faults.fault import Fault
from sensorfault.files import appearing

POINTS = 300_000  # all lines together, and at most as many again around the events: 3 to 7 MB

TRUTH_LEGEND = (
    '<span><i class="injected"></i>injected fault</span><span><i class="{missed}"></i>injected and missed</span>'
)
SCORE_LEGEND = (
    '<h2>Scores against limits</h2><p class="legend"><span><i class="score"></i>score</span>'
    '<span><i class="limit"></i>limit</span><span><i class="shade"></i>fault found</span></p>'
)


def write_page(
    detection: Detection,
    path: str | Path,
    truth: Sequence[Fault] = (),
    title: str | None = None,
    summary: Sequence[str] = (),
) -> None:
    """Write what was found to one self-contained, interactive HTML file; it appears whole or not at all.

    Args:
        detection: verdicts, tests and events; at least one tick.
        path: the file to write; an older one is replaced.
        truth: the faults that were injected, to be shown beside those found.
        title: headline, the log's name by default.
        summary: how the limits came about, one sentence each.
    """
    text = page(detection, truth, title, summary)
    with appearing(Path(path)) as temporary:
        temporary.write_text(text, encoding="utf-8")


def page(detection: Detection, truth: Sequence[Fault], title: str | None, summary: Sequence[str]) -> str:
    """The page as text."""
    from plotly.offline import get_plotlyjs

    detection = detection.heard
    charts = figures(detection, truth)
    here = files("sensorfault.evaluation")
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(
        title=escape(title or detection.log.name),
        style=here.joinpath("page.css").read_text("utf-8"),
        facts=facts(detection),
        result=result(detection),
        notes=sentences("About the log", detection.log.notes) + sentences("How the limits came about", summary),
        events=event_table(detection),
        truth=truth_table(detection, truth),
        verdict_legend=TRUTH_LEGEND.format(missed="hollow") if truth else "",
        signal_legend=TRUTH_LEGEND.format(missed="dotted") if truth else "",
        verdicts=_place("verdicts"),
        signals="".join(_signal_place(detection, i) for i in range(len(detection.log.sensors))),
        scores=SCORE_LEGEND + _place("scores") if "scores" in charts else "",
        figures=json.dumps(charts, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        plotly=get_plotlyjs(),
        script="".join(here.joinpath(name).read_text("utf-8") for name in ("page_base.js", "page.js")),
    )


def figures(detection: Detection, truth: Sequence[Fault] = ()) -> dict[str, Json]:
    """The plots by the id of their place on the page."""
    points = max(1000, POINTS // max(1, len(detection.log.channels) + len(detection.traces)))
    charts = {"verdicts": verdicts(detection, truth)}
    for i, sensor in enumerate(detection.log.sensors):
        if detection.log.of(sensor.name):
            charts[f"signals-{i}"] = signals(detection, sensor.name, truth, points)
    if detection.traces:
        charts["scores"] = scores(detection, points)
    return charts


def _place(name: str) -> str:
    return f'<div class="plot" id="{name}"></div>'


def _signal_place(detection: Detection, number: int) -> str:
    sensor = detection.log.sensors[number]
    about = f" <small>not judged, {SILENCE_ONLY}</small>" if sensor.name in blind(detection) else ""
    return f"<h3>{escape(sensor.name)}{about}</h3>" + _place(f"signals-{number}")
