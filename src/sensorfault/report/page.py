"""The report page: one HTML file that opens anywhere, offline, and asks nobody for anything."""

import json
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

from sensorfault.core.expect import DETECTION, FAULTS, expect, expect_all, expect_path
from sensorfault.core.extras import require
from sensorfault.core.files import appearing
from sensorfault.faults.fault import Fault
from sensorfault.report.page_figure import Json
from sensorfault.report.page_scores import scores
from sensorfault.report.page_signals import signals
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_verdicts import verdicts
from sensorfault.report.page_words import SILENCE_ONLY, blind, event_table, facts, headline, sentences, truth_table
from sensorfault.runtime.result import Detection

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

    Raises:
        MissingLibrary: plotly is not installed.
        TypeError: something else than a detection, a path or faults.
    """
    expect(detection, Detection, "write_page: detection", DETECTION)
    expect_path(path, "write_page: path")
    expect_all(truth, Fault, "write_page: truth", FAULTS)
    write_sketch(Sketch.of(detection.received), path, truth, title, summary, detection.log.notes)


def write_sketch(
    sketch: Sketch,
    path: str | Path,
    truth: Sequence[Fault] = (),
    title: str | None = None,
    summary: Sequence[str] = (),
    notes: Sequence[str] = (),
) -> None:
    """The same of what was gathered part by part; `notes`: what reading found."""
    require("a report page", "plotly")
    text = _page(sketch, truth, title, summary, notes)
    with appearing(Path(path)) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _page(
    sketch: Sketch, truth: Sequence[Fault], title: str | None, summary: Sequence[str], notes: Sequence[str]
) -> str:
    """The page as text."""
    from plotly.offline import get_plotlyjs

    charts = figures(sketch, truth)
    here = files("sensorfault.report")
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(
        title=escape(title or sketch.log.name),
        style=here.joinpath("page.css").read_text("utf-8"),
        facts=facts(sketch),
        headline=headline(sketch),
        notes=sentences("About the log", notes) + sentences("How the limits came about", summary),
        events=event_table(sketch),
        truth=truth_table(sketch, truth),
        verdict_legend=TRUTH_LEGEND.format(missed="hollow") if truth else "",
        signal_legend=TRUTH_LEGEND.format(missed="dotted") if truth else "",
        verdicts=_place("verdicts"),
        signals="".join(_signal_place(sketch, i) for i in range(len(sketch.log.sensors))),
        scores=SCORE_LEGEND + _place("scores") if "scores" in charts else "",
        figures=json.dumps(charts, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        plotly=get_plotlyjs(),
        script="".join(here.joinpath(name).read_text("utf-8") for name in ("page_base.js", "page.js")),
    )


def figures(sketch: Sketch, truth: Sequence[Fault] = ()) -> dict[str, Json]:
    """The plots by the id of their place on the page."""
    charts = {"verdicts": verdicts(sketch, truth)}
    for i, sensor in enumerate(sketch.log.sensors):
        if sketch.log.of(sensor.name):
            charts[f"signals-{i}"] = signals(sketch, sensor.name, truth)
    if sketch.tests:
        charts["scores"] = scores(sketch)
    return charts


def _place(name: str) -> str:
    return f'<div class="plot" id="{name}"></div>'


def _signal_place(sketch: Sketch, number: int) -> str:
    sensor = sketch.log.sensors[number]
    about = f" <small>not judged, {SILENCE_ONLY}</small>" if sensor.name in blind(sketch) else ""
    return f"<h3>{escape(sensor.name)}{about}</h3>" + _place(f"signals-{number}")
