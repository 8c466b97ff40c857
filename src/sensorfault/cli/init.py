"""`sensorfault init`: write a first vehicle.toml for an unknown log."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import options, outputs, promising, show

if TYPE_CHECKING:
    from sensorfault.logs.entries import ChannelEntry, SensorEntry


@click.command("init")
@options.log_argument
@options.rate_option
@options.out_option(None, "Where to write it.  [default: vehicle.toml beside the log]")
@click.option("--force", is_flag=True, help="Replace an existing file.")
@options.json_option
def command(log: Path, rate_hz: float | None, out: Path | None, force: bool, json_path: str | None) -> None:
    """Write a vehicle.toml for an unknown log, to be checked and corrected.

    Every line is a guess from names and values, with its reason and how sure it is. Then init says what 'detect' will
    be able to check in the log as it is described, or why it will refuse it.
    """
    from sensorfault.core.files import appearing
    from sensorfault.logs import LogError, guess
    from sensorfault.logs.place import VEHICLE

    home = log if log.is_dir() else log.parent
    target = out or home / VEHICLE
    outputs.check_outputs([target, json_path], [one for one in _logs(log) if one.name != VEHICLE])
    with show.patient(f"reading {log.name}") as tell:
        found = guess(log, tell, rate_hz)
    if target.exists() and not force:
        raise LogError(f"{target} is there already; give another --out, or --force to replace it.")
    with appearing(target) as temporary:
        temporary.write_text(found.to_toml())
    for note in found.notes:
        show.say(f"  {note}")
    for sensor in found.sensors:
        for line in _lines(sensor):
            show.say(f"  {line}")
    show.say(f"Wrote {target}: {len(found.sensors)} sensors.")
    can = promising.promise(log, found)
    beside = target.name == VEHICLE and target.parent.resolve() == home.resolve()
    for sentence in _sentences(can, f"sensorfault detect {log}{'' if beside else f' --vehicle {target}'}"):
        show.say(sentence)
    listed = {sensor.name: [_as_dict(channel) for channel in sensor.channels] for sensor in found.sensors}
    answer = {"vehicle": str(target), "sensors": listed, "notes": list(found.notes), "detect": can.as_dict()}
    show.write_json(json_path, answer)


def _logs(path: Path) -> list[Path]:
    """The file; of a folder what it holds, as an old vehicle.toml there may be replaced."""
    return list(path.iterdir()) if path.is_dir() else [path]


def _sentences(can: promising.Promise, command: str) -> Iterator[str]:
    """What detect can do with the log; `command`: how to run it."""
    yield from can.pauses
    if can.refuses:
        yield f"'{command}' will refuse this log as it is described: {can.refuses}"
        return
    yield f"Check what is a guess, then run '{command}', which can do this:"
    yield from (f"  {sentence}" for sentence in can.checks)


def _lines(sensor: "SensorEntry") -> Iterator[str]:
    """The channels of a sensor; those of one unit and one reason together."""
    alike: dict[tuple[str, str], list[str]] = {}
    for channel in sensor.channels:
        alike.setdefault((channel.unit, channel.why), []).append(channel.name)
    for (unit, why), names in alike.items():
        what = f"{', '.join(names)} [{unit}]" if unit else f"{', '.join(names)}, without a unit"
        yield f"{sensor.name}: {what}{f' - {why}' if why else ''}"


def _as_dict(channel: "ChannelEntry") -> dict[str, object]:
    sure = channel.why.partition(":")[0] if channel.unit else ""
    words = {"channel": channel.name, "column": channel.column, "unit": channel.unit, "watch": channel.watch}
    return words | {"sure": sure, "why": channel.why}
