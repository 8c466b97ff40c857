"""`sensorfault init`: write a first vehicle.toml for an unknown log."""

from pathlib import Path

import click

from sensorfault.cli import options, outputs, show


@click.command("init")
@options.log_argument
@options.out_option(None, "Where to write it.  [default: vehicle.toml beside the log]")
@click.option("--force", is_flag=True, help="Replace an existing file.")
@options.json_option
def command(log: Path, out: Path | None, force: bool, json_path: str | None) -> None:
    """Write a vehicle.toml for an unknown log, to be checked and corrected.

    Every line is a guess from names and values, with its reason.
    """
    from sensorfault.core.files import appearing
    from sensorfault.logs import LogError, guess

    target = out or (log if log.is_dir() else log.parent) / "vehicle.toml"
    outputs.check_outputs([target, json_path], [one for one in _logs(log) if one.name != "vehicle.toml"])
    with show.patient(f"reading {log.name}") as tell:
        found = guess(log, tell)
    if target.exists() and not force:
        raise LogError(f"{target} is there already; give another --out, or --force to replace it.")
    with appearing(target) as temporary:
        temporary.write_text(found.to_toml())
    for note in found.notes:
        show.say(f"  {note}")
    for sensor in found.sensors:
        channels = ", ".join(f"{c.name} [{c.unit}]" if c.unit else c.name for c in sensor.channels)
        show.say(f"  {sensor.name}: {channels}")
    show.say(f"Wrote {target}: {len(found.sensors)} sensors. Check it, then run 'sensorfault detect {log}'.")
    listed = {
        sensor.name: [
            {"channel": c.name, "column": c.column, "unit": c.unit, "watch": c.watch} for c in sensor.channels
        ]
        for sensor in found.sensors
    }
    show.write_json(json_path, {"vehicle": str(target), "sensors": listed, "notes": list(found.notes)})


def _logs(path: Path) -> list[Path]:
    """The file; of a folder what it holds, as an old vehicle.toml there may be replaced."""
    return list(path.iterdir()) if path.is_dir() else [path]
