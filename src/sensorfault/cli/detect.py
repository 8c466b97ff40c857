"""`sensorfault detect`: the faults of a log."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import long, options, show, work

if TYPE_CHECKING:
    from sensorfault.events.event import Event
    from sensorfault.logs import Log


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

    Without --model the method is fitted on the log's own beginning, which is then taken as healthy; of a long log
    that is read part by part, on no more than four million numbers.
    """
    from sensorfault.core.extras import require
    from sensorfault.events.export import check

    for out in outs:
        check(out)
    if report_path is not None:
        require("a report page", "plotly")
    work.check_outputs([*outs, report_path, json_path], [log, vehicle, model_path])
    if long.by_parts(log, by_parts):
        result = long.detect(log, vehicle, long.Wanted(model_path, method, learn, seed), report_path)
        _write(result.events, result.log, log, outs, json_path)
        show.write_json(json_path, long.answer(result))
        return
    table = work.read_log(log, vehicle)
    ready = work.ready(table, model_path, method, learn, seed)
    found = work.detect(ready.model, ready.judged)
    _write(found.events, found.log, log, outs, json_path)
    if report_path is not None:
        from sensorfault.report.page import write_page

        write_page(found, report_path, summary=ready.sentences)
        show.say(f"Wrote {report_path}.")
    show.write_json(json_path, work.answer(ready.model, found.log, table.notes, ready.fitted_on_s, found.events))


def _write(events: "Sequence[Event]", table: "Log", log: Path, outs: Sequence[Path], json_path: str | None) -> None:
    """The events as a table, and to the files asked for."""
    from sensorfault.events.export import write_events

    show.events(events, f"Faults in {table.name}", answer=json_path != "-")
    for out in outs:
        write_events(events, table, out, log if log.suffix.lower() == ".mcap" else None)
        show.say(f"Wrote {out}.")
