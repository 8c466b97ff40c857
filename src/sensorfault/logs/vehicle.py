"""`vehicle.toml`: what the columns of a log are. Written by `sensorfault init`, corrected by a person.

[vehicle]
name = "dresden"
epoch_s = 1395837505.1     # optional: Unix time at time 0, where the files do not know it
zero_s = 0.0               # optional: what the clock shows at time 0; left out: at the first row

[file.log]                 # one table for each file of the log
path = "drive.csv"         # beside this file; may be left out if the log is one file
time = "millis"            # columns of a headerless file are c1, c2, ...; may be left out for .pos
unit = "ms"                # s ms us ns iso8601
offset_s = 0.0             # added to this file's time, to put it on the common clock
tag = "imu.csv.tag"        # optional: RTKLIB's time tag, which ties a counter to GPS time

[sensor.gnss]
file = "log"               # may be left out if there is one file
held = true                # the file repeats the last measurement until the next
epoch = "time"             # optional: a column that changes exactly when a measurement arrives
watch = true               # false: values are not judged, only silence is noticed
period_s = 0.1             # optional: the usual time between measurements, where the log cannot tell
[sensor.gnss.channel]
speed = { column = "speed", unit = "km/h" }
range = { column = "range", unit = "m", missing = -1 }    # -1 stands for no value
"""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sensorfault.logs.table import LogError
from sensorfault.logs.units import UNITS, known

TIME_UNITS = ("s", "ms", "us", "ns", "iso8601")


@dataclass(frozen=True)
class ChannelEntry:
    """One column that is a channel. `missing`: the number that stands for no value."""

    name: str
    column: str
    unit: str = ""
    missing: float | None = None
    epoch: str | None = None
    why: str = field(default="", compare=False)


@dataclass(frozen=True)
class SensorEntry:
    """One sensor and the file it is in. `why` (here and elsewhere): the reason of a guess, written as a comment."""

    name: str
    channels: tuple[ChannelEntry, ...]
    file: str = "log"
    held: bool = False
    epoch: str | None = None
    watch: bool = True
    period_s: float | None = None
    why: str = field(default="", compare=False)


@dataclass(frozen=True)
class FileEntry:
    """One file and its clock."""

    name: str = "log"
    path: str | None = None
    time: str | None = None
    unit: str = "s"
    offset_s: float = 0.0
    tag: str | None = None
    why: str = field(default="", compare=False)
    left_out: tuple[tuple[str, str], ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class VehicleFile:
    """A vehicle's files, sensors and channels."""

    name: str
    files: tuple[FileEntry, ...]
    sensors: tuple[SensorEntry, ...]
    epoch_s: float | None = None
    zero_s: float | None = None
    notes: tuple[str, ...] = field(default=(), compare=False)

    @classmethod
    def read(cls, path: Path | str) -> "VehicleFile":
        """The description in a TOML file.

        Raises:
            LogError: no such file, not TOML, or a key that is unknown, missing or of another type.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise LogError(
                f"{path}: cannot read this vehicle file ({error}); `sensorfault init LOG` writes one."
            ) from None
        return cls.parse(text, str(path))

    @classmethod
    def parse(cls, text: str, where: str = "vehicle.toml") -> "VehicleFile":
        """The description in TOML text; `where` names it in errors.

        Raises:
            LogError: not TOML, or a key that is unknown, missing or of another type.
        """
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise LogError(f"{where}: this is not TOML ({error}); mend that line.") from None
        return _vehicle(_Table(table, where, ""), where)


@dataclass(frozen=True)
class _Table:
    """A TOML table that takes no key it does not know."""

    content: Mapping[str, Any]
    where: str
    path: str

    def __post_init__(self) -> None:
        if not isinstance(self.content, Mapping):
            raise LogError(f"{self.where}: '{self.path}' must be a table; write [{self.path}] above its keys.")

    def only(self, *keys: str) -> None:
        unknown = [key for key in self.content if key not in keys]
        if unknown:
            place = f"[{self.path}]" if self.path else "the top"
            raise LogError(f"{self.where}: {place} has an unknown key '{unknown[0]}'; take one of {', '.join(keys)}.")

    def tables(self, key: str) -> list[tuple[str, "_Table"]]:
        path = f"{self.path}.{key}" if self.path else key
        content = self.content.get(key)
        if content is None:
            raise LogError(f"{self.where}: there is no [{path}.NAME] table; write at least one.")
        inner = _Table(content, self.where, path).content
        return [(name, _Table(table, self.where, f"{path}.{name}")) for name, table in inner.items()]

    def text(self, key: str) -> str | None:
        return self._get(key, str, "a text in quotes")

    def flag(self, key: str, default: bool) -> bool:
        value: bool | None = self._get(key, bool, "true or false")
        return default if value is None else value

    def number(self, key: str) -> float | None:
        value = self._get(key, (int, float), "a number")
        return None if value is None else float(value)

    def _get(self, key: str, kind: type | tuple[type, ...], words: str) -> Any:
        value = self.content.get(key)
        if value is not None and (not isinstance(value, kind) or (kind is not bool and isinstance(value, bool))):
            raise LogError(f"{self.where}: [{self.path}] {key} = {value!r} must be {words}.")
        return value


def _vehicle(top: _Table, where: str) -> VehicleFile:
    top.only("vehicle", "file", "sensor")
    head = _Table(top.content.get("vehicle", {}), where, "vehicle")
    head.only("name", "epoch_s", "zero_s")
    files = tuple(_file(name, table) for name, table in top.tables("file"))
    sensors = tuple(_sensor(name, table, files) for name, table in top.tables("sensor"))
    if not files or not sensors:
        raise LogError(f"{where}: a vehicle needs a file and a sensor; write [file.log] and [sensor.NAME].")
    return VehicleFile(
        head.text("name") or "vehicle", files, sensors, epoch_s=head.number("epoch_s"), zero_s=head.number("zero_s")
    )


def _file(name: str, table: _Table) -> FileEntry:
    table.only("path", "time", "unit", "offset_s", "tag")
    unit = table.text("unit") or "s"
    if unit not in TIME_UNITS:
        raise LogError(
            f"{table.where}: [{table.path}] unit = '{unit}' is no unit of time; take one of {', '.join(TIME_UNITS)}."
        )
    return FileEntry(
        name, table.text("path"), table.text("time"), unit, table.number("offset_s") or 0.0, table.text("tag")
    )


def _sensor(name: str, table: _Table, files: tuple[FileEntry, ...]) -> SensorEntry:
    table.only("file", "held", "epoch", "watch", "period_s", "channel")
    file = table.text("file")
    if file is None:
        if len(files) > 1:
            raise LogError(
                f'{table.where}: [{table.path}] does not say which file it is in; write file = "{files[0].name}".'
            )
        file = files[0].name
    if file not in {entry.name for entry in files}:
        listed = ", ".join(entry.name for entry in files)
        raise LogError(f"{table.where}: [{table.path}] file = '{file}' is not described; take one of {listed}.")
    if "." in name:
        raise LogError(f"{table.where}: the sensor name '{name}' has a dot, which parts sensor from channel; take '_'.")
    channels = tuple(_channel(key, inner) for key, inner in table.tables("channel"))
    if not channels:
        raise LogError(f"{table.where}: [{table.path}.channel] is empty; name at least one channel.")
    return SensorEntry(
        name,
        channels,
        file,
        table.flag("held", False),
        table.text("epoch"),
        table.flag("watch", True),
        table.number("period_s"),
    )


def _channel(name: str, table: _Table) -> ChannelEntry:
    table.only("column", "unit", "missing", "epoch")
    column, unit = table.text("column"), table.text("unit") or ""
    if column is None:
        raise LogError(f'{table.where}: [{table.path}] names no column; write column = "...".')
    if not known(unit):
        raise LogError(
            f"{table.where}: [{table.path}] unit = '{unit}' is unknown; take one of {', '.join(filter(None, UNITS))}."
        )
    return ChannelEntry(name, column, unit, table.number("missing"), table.text("epoch"))


def write_vehicle_toml(vehicle: VehicleFile) -> str:
    """The TOML text of a description, with the reason of each guess as a comment; parses back to the same."""
    lines = [*(f"# {note}" for note in vehicle.notes), "[vehicle]", f"name = {_quote(vehicle.name)}"]
    if vehicle.epoch_s is not None:
        lines.append(f"epoch_s = {vehicle.epoch_s!r}")
    if vehicle.zero_s is not None:
        lines.append(f"zero_s = {vehicle.zero_s!r}")
    for file in vehicle.files:
        lines += ["", *_file_lines(file)]
    for sensor in vehicle.sensors:
        lines += ["", *_sensor_lines(sensor, single=len(vehicle.files) == 1)]
    return "\n".join(lines) + "\n"


def _file_lines(file: FileEntry) -> list[str]:
    lines = [f"[file.{_key(file.name)}]"]
    lines += [
        f"{key} = {_quote(value)}" for key, value in (("path", file.path), ("time", file.time)) if value is not None
    ]
    lines.append(f"unit = {_quote(file.unit)}" + (f"  # {file.why}" if file.why else ""))
    if file.offset_s:
        lines.append(f"offset_s = {file.offset_s!r}")
    if file.tag is not None:
        lines.append(f"tag = {_quote(file.tag)}")
    if file.left_out:
        lines.append("# Columns left out:")
        lines += [f"#   {column}: {reason}" for column, reason in file.left_out]
    return lines


def _sensor_lines(sensor: SensorEntry, single: bool) -> list[str]:
    lines = [f"[sensor.{_key(sensor.name)}]" + (f"  # {sensor.why}" if sensor.why else "")]
    if not (single and sensor.file == "log"):
        lines.append(f"file = {_quote(sensor.file)}")
    if sensor.held:
        lines.append("held = true")
    if sensor.epoch is not None:
        lines.append(f"epoch = {_quote(sensor.epoch)}")
    if not sensor.watch:
        lines.append("watch = false")
    if sensor.period_s is not None:
        lines.append(f"period_s = {sensor.period_s!r}")
    lines.append(f"[sensor.{_key(sensor.name)}.channel]")
    for channel in sensor.channels:
        cell = f"column = {_quote(channel.column)}, unit = {_quote(channel.unit)}"
        cell += f", missing = {channel.missing!r}" if channel.missing is not None else ""
        cell += f", epoch = {_quote(channel.epoch)}" if channel.epoch is not None else ""
        lines.append(f"{_key(channel.name)} = {{ {cell} }}" + (f"  # {channel.why}" if channel.why else ""))
    return lines


def _quote(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _key(name: str) -> str:
    bare = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if bare else _quote(name)
