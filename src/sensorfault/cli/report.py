"""`sensorfault report`: write the report page of a log."""

from pathlib import Path

import click

from sensorfault.cli import answer, detecting, fitting, limits, options, outputs, reading, show


@click.command("report")
@options.log_argument
@options.vehicle_option
@options.rate_option
@options.model_option
@options.detecting_method_option
@options.learn_option
@options.out_option("report.html", "The page to write.")
@click.option(
    "--truth",
    "truth_path",
    type=click.Path(path_type=Path),
    help="The faults in the log, a file that 'sensorfault inject' wrote.",
)
@options.by_parts_option
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    rate_hz: float | None,
    model_path: Path | None,
    method: str | None,
    learn: float,
    out: Path,
    truth_path: Path | None,
    by_parts: bool | None,
    seed: int,
    json_path: str | None,
) -> None:
    """Write a report page: faults, signals, scores against limits, and the verdict on each sensor over time.

    It is one interactive HTML file that needs no network.
    """
    from sensorfault.core.extras import require

    require("`sensorfault report`", "polars", "plotly")
    from sensorfault.report.page import write_page
    from sensorfault.report.page_sketch import Sketch

    outputs.check_outputs([out, json_path], [log, vehicle, model_path, truth_path])
    truth = reading.read_truth(truth_path) if truth_path else ()
    sketch = Sketch()
    choice = fitting.Choice(model_path, method, learn, seed)
    found = detecting.detect_log(log, vehicle, by_parts, choice, sketch.take, rate_hz)
    write_page(found, out, truth, summary=limits.of_detection(found), sketch=sketch)
    show.say(f"{len(found.events)} fault events. Wrote {out}.")
    show.write_json(json_path, answer.of_detection(found))
