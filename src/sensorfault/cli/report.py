"""`sensorfault report`: the page of a log."""

from pathlib import Path

import click

from sensorfault.cli import long, options, show, work


@click.command("report")
@options.log_argument
@options.vehicle_option
@options.model_option
@options.method_option
@options.learn_option
@options.out_option("report.html", "The page to write.")
@click.option(
    "--truth", "truth_path", type=click.Path(path_type=Path), help="What 'sensorfault inject' did to the log."
)
@options.by_parts_option
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    model_path: Path | None,
    method: str,
    learn: float,
    out: Path,
    truth_path: Path | None,
    by_parts: bool | None,
    seed: int,
    json_path: str | None,
) -> None:
    """Write a page: signals, scores against limits, faults, and the verdict on each sensor over time.

    One file, interactive, opens offline.
    """
    from sensorfault.core.extras import require

    require("`sensorfault report`", "polars", "plotly")
    from sensorfault.report.page import write_page

    work.check_outputs([out, json_path], [log, vehicle, model_path, truth_path])
    truth = work.read_truth(truth_path) if truth_path else ()
    if long.by_parts(log, by_parts):
        result = long.detect(log, vehicle, long.Wanted(model_path, method, learn, seed), out, truth)
        show.say(f"{len(result.events)} fault events.")
        show.write_json(json_path, long.answer(result))
        return
    table = work.read_log(log, vehicle)
    ready = work.ready(table, model_path, method, learn, seed)
    found = work.detect(ready.model, ready.judged)
    write_page(found, out, truth, summary=ready.sentences)
    show.say(f"{len(found.events)} fault events. Wrote {out}.")
    show.write_json(json_path, work.answer(ready.model, found.log, table.notes, ready.fitted_on_s, found.events))
