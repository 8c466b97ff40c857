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
@click.option("--report", "report_path", type=click.Path(path_type=Path), help="Also write a report page (HTML).")
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    model_path: Path | None,
    method: str,
    learn: float,
    report_path: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """List the faults of a log: when, which sensor and channel, what kind.

    Without --model the method is fitted on the log's own beginning, which is then taken as healthy.
    """
    work.check_outputs([report_path, json_path], [log, vehicle, model_path])
    table = work.read_log(log, vehicle)
    ready = work.ready(table, model_path, method, learn, seed)
    found = work.detect(ready.model, ready.judged)
    show.events(found.events, f"Faults in {table.name}", answer=json_path != "-")
    if report_path is not None:
        from sensorfault.evaluation.page import write_page

        write_page(found, report_path, summary=ready.sentences)
        show.say(f"Wrote {report_path}.")
    show.write_json(json_path, work.answer(table, found, ready))
