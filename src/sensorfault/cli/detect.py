"""`sensorfault detect`: the faults of a log."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import answer, detecting, fitting, limits, options, outputs, show

if TYPE_CHECKING:
    from sensorfault.report.page_sketch import Sketch


@click.command("detect")
@options.log_argument
@options.vehicle_option
@options.rate_option
@options.model_option
@options.detecting_method_option
@options.learn_option
@click.option(
    "--out",
    "outs",
    type=click.Path(path_type=Path),
    multiple=True,
    help="Also write the events: .jsonl, .csv or .parquet; .mcap with annotations for viewers (and the log's messages, "
    "if the log is an .mcap); .bag (ROS 1) or a new folder (ROS 2) with DiagnosticArray. May be given several times.",
)
@options.by_parts_option
@click.option("--report", "report_path", type=click.Path(path_type=Path), help="Also write a report page (HTML).")
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    rate_hz: float | None,
    model_path: Path | None,
    method: str | None,
    learn: float,
    outs: tuple[Path, ...],
    by_parts: bool | None,
    report_path: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """List the faults of a log: when, which sensor, what kind, and which comparison found it.

    The method auto compares every sensor with what the others say, and judges the whole log. A model that 'fit' made of
    healthy logs makes its limits sharper. Another method (--method) is fitted on the first half of the log (--learn)
    and checks the rest; of a long log read part by part, no more than four million numbers are used for the fit.
    """
    from sensorfault.events.export import check, write_events

    for out in outs:
        check(out)
    outputs.check_outputs([*outs, report_path, json_path], [log, vehicle, model_path])
    choice = fitting.Choice(model_path, method, learn, seed)
    sketch = _sketch() if report_path else None
    found = detecting.detect_log(log, vehicle, by_parts, choice, sketch.take if sketch else None, rate_hz)
    if found.events or found.judged:
        show.events(found.events, f"Faults in {found.log.name}", answer=json_path != "-")
    else:
        show.say(limits.of_unjudged(found))
    for sentence in limits.of_coverage(found):
        show.say(sentence)
    for out in outs:
        write_events(found.events, found.log, out, log if log.suffix.lower() == ".mcap" else None)
        show.say(f"Wrote {out}.")
    if report_path is not None:
        from sensorfault.report.page import write_page

        write_page(found, report_path, summary=limits.of_detection(found), sketch=sketch)
        show.say(f"Wrote {report_path}.")
    show.write_json(json_path, answer.of_detection(found))


def _sketch() -> "Sketch":
    from sensorfault.core.extras import require

    require("a report page", "plotly")
    from sensorfault.report.page_sketch import Sketch

    return Sketch()
