"""`sensorfault detect`: the faults of a log."""

from pathlib import Path

import click

from sensorfault.cli import answer, detecting, fitting, limits, options, outputs, show


@click.command("detect")
@options.log_argument
@options.vehicle_option
@options.model_option
@options.method_option
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
    model_path: Path | None,
    method: str,
    learn: float,
    outs: tuple[Path, ...],
    by_parts: bool | None,
    report_path: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """List the faults of a log: when, which sensor and channel, what kind.

    Without --model, the first half of the log is assumed healthy to fit the method, and the second half is checked.
    --learn changes that share. Of a long log read part by part, no more than four million numbers are used for the fit.
    """
    from sensorfault.core.extras import require
    from sensorfault.events.export import check, write_events
    from sensorfault.report.page import write_page
    from sensorfault.report.page_sketch import Sketch

    for out in outs:
        check(out)
    if report_path is not None:
        require("a report page", "plotly")
    outputs.check_outputs([*outs, report_path, json_path], [log, vehicle, model_path])
    choice = fitting.Choice(model_path, method, learn, seed)
    sketch = Sketch() if report_path else None
    found = detecting.detect_log(log, vehicle, by_parts, choice, sketch.take if sketch else None)
    show.events(found.events, f"Faults in {found.log.name}", answer=json_path != "-")
    for out in outs:
        write_events(found.events, found.log, out, log if log.suffix.lower() == ".mcap" else None)
        show.say(f"Wrote {out}.")
    if report_path is not None:
        write_page(found, report_path, summary=limits.of_detection(found), sketch=sketch)
        show.say(f"Wrote {report_path}.")
    show.write_json(json_path, answer.of_detection(found))
