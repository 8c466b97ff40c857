"""`vehicle.toml`: what the columns of a log are. `sensorfault init` writes it, a person corrects it.

[vehicle]
name = "dresden"
epoch_s = 1395837505.1     # optional: Unix time at time 0, where the files do not know it
zero_s = 0.0               # optional: what the clock shows at time 0; left out: at the first row
wheelbase_m = 2.65         # optional: distance of the axles, with which a steering angle turns the bicycle model
steering_ratio = 14.5      # optional: angle of the steering wheel over that of the front wheels; else learned

[file.log]                 # one table for each file of the log
path = "drive.csv"         # beside this file; may be left out if the log is one file
time = "millis"            # columns of a headerless file are c1, c2, ...; may be left out for .pos
unit = "ms"                # s ms us ns min h; iso8601; a format as "%d.%m.%Y %H:%M:%S%.f"; excel, datenum: days;
                           # filetime, ticks, unix100ns: 100 ns of Windows, of .NET, and since 1970
# fine = "clock"           # a column that goes on where the first ends: the clock beside a date (unit: both formats
                           # with a blank between), or the rest of a time in s+ms, s+us, s+ns, week+s, week+ms
# rate_hz = 100.0          # instead of time: rows a second of a file without a clock
offset_s = 0.0             # added to this file's time, to put it on the common clock
table = "GPS"              # optional: which one, where a file holds several tables (.bin, .mat)
tag = "imu.csv.tag"        # optional: RTKLIB's time tag, which ties a counter to GPS time

[sensor.gnss]
file = "log"               # may be left out if there is one file
held = true                # the file repeats the last measurement until the next
epoch = "time"             # optional: a column that changes exactly when a measurement arrives
watch = true               # false: no channel of it is judged, only its dropouts are detected
period_s = 0.1             # optional: the usual time between measurements, where the log does not show it
[sensor.gnss.channel]
speed = { column = "speed", unit = "km/h" }
course = { column = "course", unit = "deg", watch = false }  # this channel alone is not judged
range = { column = "range", unit = "m", missing = -1 }    # -1 means no value
far = { column = "far", unit = "m", epoch = "far_time" }  # a channel that arrives at its own times
latitude = { column = "lat", unit = "deg", valid = "fix_type >= 2" }  # no value where that does not hold
fix_type = { column = "fix_type", kind = "quality" }      # estimate, quality or context, see the README of logs
"""

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

from sensorfault.logs.entries import ChannelEntry, FileEntry, SensorEntry
from sensorfault.logs.table import KINDS, SAID, LogError
from sensorfault.logs.time_units import JOINED, TIME_UNITS, is_time_unit
from sensorfault.logs.toml_table import TomlTable
from sensorfault.logs.toml_text import comment, file_lines, quote, sensor_lines
from sensorfault.logs.units import UNITS, known
from sensorfault.logs.validity import Validity


@dataclass(frozen=True)
class VehicleFile:
    """A vehicle's files, sensors and channels. `where`: what says so, in messages. `guessed`: nobody has checked it."""

    name: str
    files: tuple[FileEntry, ...]
    sensors: tuple[SensorEntry, ...]
    epoch_s: float | None = None
    zero_s: float | None = None
    wheelbase_m: float | None = None
    steering_ratio: float | None = None
    notes: tuple[str, ...] = field(default=(), compare=False)
    where: str = field(default="the vehicle file", compare=False)
    guessed: bool = field(default=False, compare=False)

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
            raise LogError(f"{where}: this is not TOML ({error}); correct that line.") from None
        return _vehicle(TomlTable(table, where, ""), where)

    @property
    def asides(self) -> frozenset[str]:
        """Files that hold nothing but quality and context. A log may lack them: states are written when they change."""
        needed = {s.file for s in self.sensors if any(c.kind not in SAID for c in s.channels)}
        return frozenset(file.name for file in self.files) - needed

    def to_toml(self) -> str:
        """The TOML text, with the reason of each guess as a comment; it parses back to the same."""
        lines = [*(comment(note) for note in self.notes), "[vehicle]", f"name = {quote(self.name)}"]
        if self.epoch_s is not None:
            lines.append(f"epoch_s = {self.epoch_s!r}")
        if self.zero_s is not None:
            lines.append(f"zero_s = {self.zero_s!r}")
        sizes = {"wheelbase_m": self.wheelbase_m, "steering_ratio": self.steering_ratio}
        lines += [f"{name} = {size!r}" for name, size in sizes.items() if size is not None]
        for file in self.files:
            lines += ["", *file_lines(file)]
        for sensor in self.sensors:
            lines += ["", *sensor_lines(sensor, single=len(self.files) == 1)]
        return "\n".join(lines) + "\n"


def sound_rate(rate_hz: float) -> float:
    """The rate, if it is one.

    Raises:
        LogError: it is not positive, or not finite.
    """
    if not 0 < rate_hz < float("inf"):
        raise LogError(f"a rate of {rate_hz:g} Hz was given; give how many rows come in a second, a positive number.")
    return rate_hz


def with_rate(vehicle: VehicleFile, rate_hz: float) -> VehicleFile:
    """The description with this rate for the files that have no clock.

    Raises:
        LogError: the rate is not positive, or each file has a clock.
    """
    sound_rate(rate_hz)
    if all(file.rate_hz is None for file in vehicle.files):
        clock = next((file.time for file in vehicle.files if file.time is not None), None)
        raise LogError(
            f"{vehicle.name}: a rate is for tables without a clock, but its clock is "
            f"{f'the column {clock!r}' if clock else 'that of its format'}; leave out the rate."
        )
    files = tuple(file if file.rate_hz is None else replace(file, rate_hz=rate_hz) for file in vehicle.files)
    return replace(vehicle, files=files)


def _vehicle(top: TomlTable, where: str) -> VehicleFile:
    top.only("vehicle", "file", "sensor")
    head = TomlTable(top.content.get("vehicle", {}), where, "vehicle")
    head.only("name", "epoch_s", "zero_s", "wheelbase_m", "steering_ratio")
    sizes = {name: head.number(name) for name in ("wheelbase_m", "steering_ratio")}
    for name, size in sizes.items():
        if size is not None and not 0 < size < float("inf"):
            raise LogError(f"{where}: [vehicle] {name} = {size:g} must be positive; correct it, or leave it out.")
    files = tuple(_file(name, table) for name, table in top.tables("file"))
    sensors = tuple(_sensor(name, table, files) for name, table in top.tables("sensor"))
    if not files or not sensors:
        raise LogError(f"{where}: a vehicle needs a file and a sensor; write [file.log] and [sensor.NAME].")
    return VehicleFile(
        head.text("name") or "vehicle",
        files,
        sensors,
        epoch_s=head.number("epoch_s"),
        zero_s=head.number("zero_s"),
        wheelbase_m=sizes["wheelbase_m"],
        steering_ratio=sizes["steering_ratio"],
        where=where,
    )


def _file(name: str, table: TomlTable) -> FileEntry:
    table.only("path", "time", "unit", "offset_s", "tag", "table", "fine", "rate_hz")
    unit = table.text("unit") or "s"
    if not is_time_unit(unit):
        raise LogError(
            f"{table.where}: [{table.path}] unit = '{unit}' is no unit of time; take one of {', '.join(TIME_UNITS)}, "
            'or a format such as "%d.%m.%Y %H:%M:%S%.f".'
        )
    time, fine, rate_hz = table.text("time"), table.text("fine"), table.number("rate_hz")
    if rate_hz is not None and (time is not None or not 0 < rate_hz < float("inf")):
        raise LogError(f"{table.where}: [{table.path}] rate_hz is for a file without time; give a positive number.")
    if (fine is None) == (unit in JOINED) and not (fine is not None and "%" in unit):
        raise LogError(
            f"{table.where}: [{table.path}] the key fine belongs to the units {', '.join(JOINED)}, and to formats of a "
            "date and a clock in two columns."
        )
    offset = table.number("offset_s") or 0.0
    return FileEntry(
        name, table.text("path"), time, unit, offset, table.text("tag"), table.text("table"), fine, rate_hz
    )


def _sensor(name: str, table: TomlTable, files: tuple[FileEntry, ...]) -> SensorEntry:
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
        raise LogError(
            f"{table.where}: the sensor name '{name}' has a dot, which separates sensor and channel; use '_'."
        )
    watch = table.flag("watch", True)
    channels = tuple(_channel(key, inner, watch) for key, inner in table.tables("channel"))
    if not channels:
        raise LogError(f"{table.where}: [{table.path}.channel] is empty; name at least one channel.")
    return SensorEntry(
        name,
        channels,
        file,
        table.flag("held", False),
        table.text("epoch"),
        table.number("period_s"),
    )


def _channel(name: str, table: TomlTable, watch: bool) -> ChannelEntry:
    """`watch`: that of its sensor, unless the channel sets its own."""
    table.only("column", "unit", "missing", "epoch", "watch", "valid", "kind")
    column, unit = table.text("column"), table.text("unit") or ""
    if column is None:
        raise LogError(f'{table.where}: [{table.path}] names no column; write column = "...".')
    if not known(unit):
        raise LogError(
            f"{table.where}: [{table.path}] unit = '{unit}' is unknown; take one of {', '.join(filter(None, UNITS))}."
        )
    valid, kind = table.text("valid"), table.text("kind") or ""
    if valid is not None:
        Validity.parse(valid, f"{table.where}: [{table.path}] valid =")
    if kind not in KINDS:
        listed = ", ".join(filter(None, KINDS))
        raise LogError(f"{table.where}: [{table.path}] kind = '{kind}' is unknown; take one of {listed}.")
    watch = table.flag("watch", watch and kind not in SAID)
    return ChannelEntry(name, column, unit, table.number("missing"), table.text("epoch"), watch, valid, kind)
