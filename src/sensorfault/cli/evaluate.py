"""`sensorfault evaluate`: how well a method detects faults in a log."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import cells, detecting, fitting, limits, options, outputs, reading, show
from sensorfault.core.times import clock

if TYPE_CHECKING:
    from sensorfault.evaluation.campaign import Campaign
    from sensorfault.evaluation.judge import Judgement
    from sensorfault.logs import Log


@click.command("evaluate")
@options.log_argument
@options.vehicle_option
@options.rate_option
@options.model_option
@options.method_option
@options.learn_option
@click.option(
    "--truth",
    "truth_path",
    type=click.Path(path_type=Path),
    help="The faults in the log, a file that 'sensorfault inject' wrote. Without it, evaluate injects faults itself.",
)
@click.option("--duration", "duration_s", default=5.0, show_default=True, help="Length of each injected fault [s].")
@click.option(
    "--repeats", default=3, show_default=True, type=click.IntRange(min=1), help="How often to inject each fault."
)
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    rate_hz: float | None,
    model_path: Path | None,
    method: str | None,
    learn: float,
    truth_path: Path | None,
    duration_s: float,
    repeats: int,
    seed: int,
    json_path: str | None,
) -> None:
    """Measure recall, delay, isolation, recovery and false alarms an hour.

    The model is never evaluated on the data it was fitted on: without --model, it is fitted on the first half of the
    log and evaluated on the second.
    """
    from sensorfault.evaluation.campaign import campaign
    from sensorfault.evaluation.judge import judge

    outputs.check_outputs([json_path], [log, vehicle, model_path, truth_path])
    truth = reading.read_truth(truth_path) if truth_path else None
    choice = fitting.Choice(model_path, method, learn, seed)
    table = reading.read_log(log, vehicle, fitting.known_by(choice), rate_hz=rate_hz)
    model, rest = fitting.model_and_rest(choice, table)
    if truth is not None:
        begun = [fault for fault in truth if fault.start_s >= rest.time[0]]
        judgement = judge(detecting.detect(model, rest), begun)
        _show_judgement(judgement, len(truth) - len(begun), json_path)
        return
    with show.progress() as bar:
        task = bar.add_task("injecting and judging", total=1.0)
        done = campaign(
            model,
            rest,
            duration_s=duration_s,
            repeats=repeats,
            seed=seed,
            progress=lambda share: bar.update(task, completed=share),
        )
    _show_campaign(table, done, json_path)


def _alarms(judgement: "Judgement") -> str:
    known = limits.alarms(len(judgement.false_alarms), 3600 * judgement.healthy_hours)
    return f"False alarms where nothing was injected: {known}."


def _show_judgement(judgement: "Judgement", learned: int, json_path: str | None) -> None:
    from sensorfault.logs.phrase import counted

    columns = ("fault", "found", "delay [s]", "as", "sensor", "channel", "kind", "false isolations")
    rows = []
    for outcome in judgement.outcomes:
        named = outcome.named
        found = "" if named is None else f"{named.kind} on {named.where}"
        right = tuple(
            "right" if r else "wrong" for r in (outcome.sensor_right, outcome.channel_right, outcome.kind_right)
        )
        delay = cells.number(outcome.delay_s)
        words = f"{clock(outcome.fault.start_s)} {cells.fault_words(outcome.fault)}"
        result = (*right, str(outcome.false_isolations)) if outcome.found else ("", "", "", "")
        rows.append((words, "yes" if outcome.found else "no", delay, found, *result))
    show.table("Injected faults", columns, rows, json_path != "-")
    if learned:
        show.say(f"{counted(learned, 'fault')} in the part that was fitted on: not evaluated.")
    show.say(_alarms(judgement))
    show.write_json(
        json_path,
        {
            "outcomes": [asdict(outcome) for outcome in judgement.outcomes],
            "false_alarms": [event.as_dict() for event in judgement.false_alarms],
            "false_alarms_per_hour": judgement.false_alarms_per_hour,
            "false_alarms_per_hour_below": judgement.false_alarms_per_hour_below,
            "healthy_hours": judgement.healthy_hours,
        },
    )


def _show_campaign(log: "Log", done: "Campaign", json_path: str | None) -> None:
    columns = (
        *("fault", "magnitude", "on", "n", "recall %", "chance %", "delay 50 [s]", "95 [s]"),
        *("sensor %", "channel %", "kind %", "false isolations", "error left %"),
    )
    rows = [
        (
            *(cell.kind, cells.number(cell.magnitude), cell.channel, str(cell.faults)),
            *(cells.percent(cell.recall), cells.percent(cell.chance)),
            *(cells.number(cell.delay_p50_s), cells.number(cell.delay_p95_s)),
            *(cells.percent(x) for x in (cell.sensor_right, cell.channel_right, cell.kind_right)),
            *(cells.number(cell.false_isolations), cells.percent(cell.recovery)),
        )
        for cell in done.cells
    ]
    show.table(f"{log.name} with injected faults", columns, rows, json_path != "-")
    show.say(
        "Magnitude: of spike, offset and noise in standard deviations of the channel, of drift in the same a second, "
        "of scale a factor, of delay in seconds. Chance: probability of an alarm in an equally long window without a "
        "fault. False isolations: events on healthy channels, for each fault. Error left: error of the repaired value, "
        "as a share of the error of the faulty value."
    )
    show.say(_alarms(done.untouched))
    show.say(f"Over all faulty samples: AUC {done.auc:.3f}, AUC-PR {done.auc_pr:.3f}.")
    show.write_json(
        json_path,
        {
            "cells": [asdict(cell) for cell in done.cells],
            "isolation": done.isolation(),
            "false_alarms_per_hour": done.untouched.false_alarms_per_hour,
            "false_alarms_per_hour_below": done.untouched.false_alarms_per_hour_below,
            "healthy_hours": done.untouched.healthy_hours,
            "auc": done.auc,
            "auc_pr": done.auc_pr,
        },
    )
