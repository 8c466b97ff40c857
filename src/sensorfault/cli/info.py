"""`sensorfault info`: what a log holds, and which methods apply to it."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import cells, options, outputs, reading, show
from sensorfault.core.times import clock

if TYPE_CHECKING:
    from sensorfault.logs import Log
    from sensorfault.logs.summary import SensorSummary

_COLUMNS = ("sensor", "channels", "rate [Hz]", "n", "gaps", "longest [s]", "at", "held %")


@click.command("info")
@options.log_argument
@options.vehicle_option
@options.rate_option
@options.by_parts_option
@options.json_option
def command(
    log: Path, vehicle: Path | None, rate_hz: float | None, by_parts: bool | None, json_path: str | None
) -> None:
    """List what a log holds: sensors, rates, gaps, held values; which methods apply to it, and why others do not.

    Nothing is fitted. A method that seems to apply may still turn out to need more data when it is fitted.
    """
    from dataclasses import asdict

    from sensorfault.logs.summary import Summing

    outputs.check_outputs([json_path], [log, vehicle])
    summing = Summing()
    said = reading.read_in(reading.in_parts(log, by_parts), log, vehicle, summing.take, rate_hz=rate_hz)
    table, sensors = summing.first, summing.sensors
    assert table is not None  # a log without a row is an error
    applies, lacking, without = _methods(table.measurements())
    answer = json_path != "-"
    show.table(f"Sensors of {table.name}", _COLUMNS, [_row(one) for one in sensors], answer, right=("gaps", "at"))
    rows = [(name, "yes" + (f", without {', '.join(without[name])}" if without[name] else "")) for name in applies]
    rows += [(", ".join(names), f"no: {reason}") for reason, names in _by_reason(lacking).items()]
    show.table("Methods", ("method", "applies"), rows, answer)
    result = {
        "log": table.name,
        "duration_s": summing.end_s - float(table.time[0]),
        "tick_s": table.period_s,
        "rows": summing.rows,
        "epoch_s": table.epoch_s,
        "sensors": [asdict(sensor) for sensor in sensors],
        "notes": list(said.notes),
        "damage": list(said.damage),
        "pauses": summing.pauses.tolist(),
        "applies": {name: {"without": without[name]} for name in applies},
        "does_not_apply": lacking,
    }
    show.write_json(json_path, result)


def _methods(table: "Log") -> tuple[list[str], dict[str, str], dict[str, dict[str, str]]]:
    """Methods that apply, why others do not, and which parts of the first cannot run."""
    from sensorfault.methods.catalog import METHODS

    lacking = {name: reason for name, recipe in METHODS.items() if (reason := recipe.lacks(table))}
    applies = [name for name in METHODS if name not in lacking]
    return applies, lacking, {name: METHODS[name].lacking_parts(table) for name in applies}


def _by_reason(lacking: dict[str, str]) -> dict[str, list[str]]:
    """Each reason once, with all methods that do not apply for that reason."""
    methods: dict[str, list[str]] = {}
    for name, reason in lacking.items():
        methods.setdefault(reason, []).append(name)
    return methods


def _row(sensor: "SensorSummary") -> tuple[str, ...]:
    units = zip(sensor.channels, sensor.units, strict=True)
    return (
        sensor.name,
        ", ".join(f"{channel} [{unit}]" if unit else channel for channel, unit in units),
        cells.number(sensor.rate_hz),
        str(sensor.measurements),
        str(sensor.gaps),
        cells.number(sensor.longest_gap_s),
        "" if sensor.gap_at_s is None else clock(sensor.gap_at_s),
        cells.percent(sensor.held) if sensor.held else "",
    )
