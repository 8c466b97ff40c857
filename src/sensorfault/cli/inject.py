"""`sensorfault inject`: put faults into a log, and write down which."""

from pathlib import Path

import click

from sensorfault.cli import cells, options, outputs, reading, show
from sensorfault.core.times import clock


@click.command("inject")
@options.log_argument
@options.vehicle_option
@options.rate_option
@click.option(
    "--fault",
    "faults",
    multiple=True,
    required=True,
    metavar="KIND:SENSOR[.CHANNEL]:ONSET:DURATION[:MAGNITUDE[sigma]]",
    help="For example offset:gyro.z:120:20:5sigma, frozen:gnss:60:10 or spike:gyro.x:30:0:0.5; may be given several "
    "times. KIND is spike, offset, drift, frozen, missing, noise, scale or delay; times in seconds of the log.",
)
@options.out_option(None, "The log to write, .csv or .parquet.")
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    rate_hz: float | None,
    faults: tuple[str, ...],
    out: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """Put faults into a log. Writes the log and, beside it, its vehicle.toml and the list of faults (.truth.json)."""
    from sensorfault.core.files import appearing
    from sensorfault.faults.inject import inject
    from sensorfault.faults.text import parse_fault, truth_to_json
    from sensorfault.logs import LogError, write

    if out is None:
        raise LogError("no --out was given; name the log to write, such as --out faulty.csv.")
    truth_path = out.with_suffix(".truth.json")
    vehicle_path = out.with_suffix(".vehicle.toml")
    outputs.check_outputs([out, truth_path, vehicle_path, json_path], [log, vehicle])
    table = reading.read_log(log, vehicle, rate_hz=rate_hz)
    injected = inject(table, [parse_fault(text, table) for text in faults], seed)
    write(injected.log, out)
    with appearing(truth_path) as temporary:
        temporary.write_text(truth_to_json(injected.truth) + "\n")
    for fault in injected.truth:
        show.say(f"  {clock(fault.start_s)} to {clock(fault.end_s)}: {cells.fault_words(fault)}")
    show.say(f"Wrote {out} and {truth_path}.")
    show.write_json(json_path, {"log": str(out), "truth": [fault.as_dict() for fault in injected.truth]})
