"""A log: the measurements of all sensors on one clock."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.core import html
from sensorfault.core.extras import require
from sensorfault.core.times import clock
from sensorfault.logs.jumps import Jump
from sensorfault.logs.pauses import Pauses, pauses_of
from sensorfault.logs.phrase import counted, listed, sensors_named, with_unit
from sensorfault.logs.units import from_si

if TYPE_CHECKING:
    import polars

    from sensorfault.logs.vehicle import VehicleFile


class LogError(ValueError):
    """A log, a vehicle file or a model that cannot be used. One sentence: what is wrong, where, and what to do."""


KINDS = ("", "estimate", "quality", "context")
SAID = KINDS[2:]  # what is said beside the measurements: never judged


@dataclass(frozen=True)
class Channel:
    """One number of one sensor.

    `unit` is for display; values in a Log are SI. `watch`: whether a method may judge them (a latitude is not a
    stationary signal; only its dropouts are detected).
    `kind`: "" of a measurement; "estimate" of what an estimator computed from several sensors; "quality" of what a
    sensor says of itself; "context" of what the vehicle does.
    """

    name: str
    sensor: str
    unit: str = ""
    watch: bool = True
    kind: str = ""

    @property
    def path(self) -> str:
        """`sensor.channel`, unique in a log."""
        return f"{self.sensor}.{self.name}"


@dataclass(frozen=True)
class Sensor:
    """A device that delivers its channels together.

    `period_s`: the usual time between two new measurements. `held`: the file repeats the last measurement until the
    next (zero-order hold), so a repeated row is not a new measurement.
    """

    name: str
    period_s: float
    held: bool = False


@dataclass(frozen=True)
class Log:
    """T ticks of one clock, C channels.

    `time` [s] rises strictly and starts at 0 at the first row read (`epoch_s`, Unix time, if the file knew it).
    `value` is SI, NaN where nothing arrived. `fresh` marks new measurements, not held ones: fresh implies a value.
    `wheelbase_m` and `steering_ratio` are the vehicle's, if its file says them.
    `notes`: remarks from reading (clock faults, held rows, guesses), one sentence each.
    `block`: what a residual generator takes besides, arrays with an entry for each tick (see `epochs`).
    `jumps`: of the clock, which were taken out of `time`.
    `damage`: those of them that say where a file could not be read, and what was read all the same.
    `description`: what its columns were read as, by a vehicle.toml, a model or a guess; None of a log made by hand.
    """

    time: Float[np.ndarray, " T"]
    value: Float[np.ndarray, "T C"]
    fresh: Bool[np.ndarray, "T C"]
    channels: tuple[Channel, ...]
    sensors: tuple[Sensor, ...]
    name: str = "log"
    notes: tuple[str, ...] = ()
    damage: tuple[str, ...] = ()
    epoch_s: float | None = None
    wheelbase_m: float | None = None
    steering_ratio: float | None = None
    block: Any = ()
    description: "VehicleFile | None" = field(default=None, repr=False, compare=False)
    jumps: tuple[Jump, ...] = ()

    def __post_init__(self) -> None:
        rows, width = self.value.shape
        if self.time.shape != (rows,) or self.fresh.shape != (rows, width) or len(self.channels) != width:
            raise LogError(
                f"{self.name}: {rows} rows of {width} values do not fit {self.time.size} times, "
                f"{self.fresh.shape} fresh marks and {len(self.channels)} channels; give one of each a row or column."
            )

    def __repr__(self) -> str:
        return f"<Log {self._line()}>"

    def _line(self) -> str:
        """`'drive': 5000 rows in 1:40.00 at 50 Hz, sensors gyro, accelerometer, gnss`."""
        rate = f" at {1 / self.period_s:.3g} Hz" if len(self) > 1 else ""
        rows = f"{counted(len(self), 'row')} in {clock(self.duration_s)}{rate}"
        return f"{self.name!r}: {rows}, {sensors_named([sensor.name for sensor in self.sensors])}"

    def _repr_html_(self) -> str:
        """One row a sensor: channels with their units, how often it measures, the share of it that arrived."""
        rows = []
        for sensor in self.sensors:
            columns = list(self.of(sensor.name))
            due = self.period_s / sensor.period_s if sensor.period_s > self.period_s else 1.0  # measurements a tick
            share = min(1.0, float(self.fresh[:, columns].mean()) / due) if len(self) else 0.0
            every = f"{sensor.period_s:.3g} s" if np.isfinite(sensor.period_s) else ""
            channels = listed([with_unit(self.channels[i].name, self.channels[i].unit) for i in columns])
            rows.append((sensor.name, channels, every, "yes" if sensor.held else "", f"{share:.0%}"))
        sensors = html.table(("sensor", "channels", "every", "held", "received"), rows)
        notes = [html.table(("notes",), [(note,) for note in self.notes])] if self.notes else []
        return html.page(f"Log {self._line()}", sensors, *notes)

    def __len__(self) -> int:
        return len(self.time)

    @property
    def duration_s(self) -> float:
        """From the first tick to the last [s]."""
        return float(self.time[-1] - self.time[0]) if len(self) else 0.0

    @property
    def period_s(self) -> float:
        """The usual time between two ticks [s]."""
        return float(np.median(np.diff(self.time))) if len(self) > 1 else float("nan")

    @property
    def pauses(self) -> Pauses:
        """Pauses of the recording, start and end [s] of each: the clock steps by more than three of its periods.

        No sensor has a value there, and nothing is said of any.
        """
        return pauses_of(self.time, self.period_s)

    @cached_property
    def arrived(self) -> Bool[np.ndarray, "T C"]:
        """Where a channel has a new value."""
        arrived: Bool[np.ndarray, "T C"] = self.fresh & np.isfinite(self.value)
        return arrived

    @cached_property
    def measured(self) -> Float[np.ndarray, " C"]:
        """The share of ticks in which a channel has a new value."""
        return np.array([np.count_nonzero(channel) for channel in self.arrived.T]) / max(1, len(self))

    @cached_property
    def changes(self) -> Bool[np.ndarray, " C"]:
        """Whether the new values of a channel are not all the same."""
        most = np.max(self.value, axis=0, initial=-np.inf, where=self.arrived)
        changes: Bool[np.ndarray, " C"] = most > np.min(self.value, axis=0, initial=np.inf, where=self.arrived)
        return changes

    def index(self, path: str) -> int:
        """Column of the channel `sensor.channel`; the channel's name alone is enough where it is unique.

        Raises:
            LogError: no such channel, or several.
        """
        found = [i for i, c in enumerate(self.channels) if path in (c.path, c.name)]
        exact = [i for i, c in enumerate(self.channels) if path == c.path]
        if len(exact or found) != 1:
            known = ", ".join(c.path for c in self.channels)
            what = "more than one channel is" if found else "no channel is"
            raise LogError(f"{self.name}: {what} called '{path}'; take one of {known}.")
        return (exact or found)[0]

    def of(self, sensor: str) -> tuple[int, ...]:
        """Columns of one sensor.

        Raises:
            LogError: no such sensor.
        """
        if sensor not in {s.name for s in self.sensors}:
            known = ", ".join(s.name for s in self.sensors)
            raise LogError(f"{self.name}: no sensor is called '{sensor}'; take one of {known}.")
        return tuple(i for i, c in enumerate(self.channels) if c.sensor == sensor)

    def between(self, start_s: float = -np.inf, end_s: float = np.inf) -> "Log":
        """The rows with start_s <= time < end_s; times stay as they are."""
        rows = slice(*np.searchsorted(self.time, (start_s, end_s)))
        return self._rows(rows)

    def without(self, rows: Int[np.ndarray, " n"]) -> "Log":
        """The log with these rows cut out; times stay as they are."""
        return self._rows(np.delete(np.arange(len(self)), rows))

    def _rows(self, rows: Any) -> "Log":
        block = type(self.block)(*(array[rows] for array in self.block))
        return replace(self, time=self.time[rows], value=self.value[rows], fresh=self.fresh[rows], block=block)

    def select(self, paths: Iterable[str]) -> "Log":
        """The same log with only these channels, in this order."""
        columns = [self.index(path) for path in paths]
        kept = {self.channels[i].sensor for i in columns}
        return replace(
            self,
            value=self.value[:, columns],
            fresh=self.fresh[:, columns],
            channels=tuple(self.channels[i] for i in columns),
            sensors=tuple(s for s in self.sensors if s.name in kept),
        )

    def measurements(self) -> "Log":
        """The log without quality and context, and without the estimates of which nothing may be judged."""
        judged = {c.sensor for c in self.channels if c.watch or not c.kind}
        kept = [c.path for c in self.channels if c.kind not in SAID and c.sensor in judged]
        return self if len(kept) == len(self.channels) else self.select(kept)

    def frame(self) -> "polars.DataFrame":
        """A table for people: `time_s` and one column `sensor.channel` in the channel's own unit, null where absent.

        Raises:
            MissingLibrary: polars is not installed.
        """
        require("a table", "polars")
        import polars as pl

        columns: dict[str, Any] = {"time_s": self.time}
        for i, channel in enumerate(self.channels):
            columns[channel.path] = from_si(self.value[:, i], channel.unit)
        return pl.DataFrame(columns).with_columns(pl.exclude("time_s").fill_nan(None))
