"""The report page: one HTML file that opens in any browser, offline; it loads nothing from a network."""

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
from sensorfault.report.page_words import DROPOUTS_ONLY, blind, event_table, facts, headline, sentences, truth_table
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
    sketch: Sketch | None = None,
) -> None:
    """Write a detection to one self-contained, interactive HTML file, whole or not at all.

    Args:
        detection: what `detect` or `detect_file` found.
        path: the file to write; an existing one is replaced.
        truth: the injected faults, shown beside those found.
        title: headline, the log's name by default.
        summary: sentences about the model's limits.
        sketch: what is drawn. By default it is taken from the detection's rows; for a log judged in parts, gather it
            while they are judged: `detect_file(model, path, see=sketch.take)`.

    Raises:
        RowsNotKept: the log was judged in parts and there is no sketch.
        MissingLibrary: plotly is not installed.
        TypeError: something else than a detection, a path or faults.
    """
    expect(detection, Detection, "write_page: detection", DETECTION)
    expect_path(path, "write_page: path")
    expect_all(truth, Fault, "write_page: truth", FAULTS)
    require("a report page", "plotly")
    text = _page(sketch or Sketch.of(detection.received), truth, title, summary, detection.notes)
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
        notes=sentences("About the log", notes) + sentences("Limits of the model", summary),
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
    """The figures by the id of their place on the page."""
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
    about = f" <small>{DROPOUTS_ONLY}</small>" if sensor.name in blind(sketch) else ""
    return f"<h3>{escape(sensor.name)}{about}</h3>" + _place(f"signals-{number}")
