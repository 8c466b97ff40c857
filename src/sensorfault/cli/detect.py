"""`sensorfault detect`: the faults of a log."""

from pathlib import Path

import click

from sensorfault.cli import options, show, work


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
    help="Also write the events: .jsonl, .csv or .parquet; .mcap, annotations for viewers (with the log's messages, "
    "if it is an .mcap); .bag (ROS 1) or a new folder (ROS 2) of DiagnosticArray. May be given several times.",
)
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
    report_path: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """List the faults of a log: when, which sensor and channel, what kind.

    Without --model the method is fitted on the log's own beginning, which is then taken as healthy.
    """
    from sensorfault.export import check, write_events

    for out in outs:
        check(out)
    work.check_outputs([*outs, report_path, json_path], [log, vehicle, model_path])
    table = work.read_log(log, vehicle)
    ready = work.ready(table, model_path, method, learn, seed)
    found = work.detect(ready.model, ready.judged)
    show.events(found.events, f"Faults in {table.name}", answer=json_path != "-")
    for out in outs:
        write_events(found.events, found.log, out, log if log.suffix.lower() == ".mcap" else None)
        show.say(f"Wrote {out}.")
    if report_path is not None:
        from sensorfault.evaluation.page import write_page

        write_page(found, report_path, summary=ready.sentences)
        show.say(f"Wrote {report_path}.")
    show.write_json(json_path, work.answer(table, found, ready))
