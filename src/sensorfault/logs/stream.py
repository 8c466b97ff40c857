"""One file of a log: the measurements of its sensors in SI on the file's own clock."""

from dataclasses import dataclass

import numpy as np
import polars as pl
from jaxtyping import Bool, Float

from sensorfault.logs.clock import Clock, read_clock
from sensorfault.logs.entries import ChannelEntry, FileEntry, SensorEntry
from sensorfault.logs.held import STALE, fresh_rows, looks_held, share_old, share_repeated, stale, usual_period_s
from sensorfault.logs.jumps import Jump
from sensorfault.logs.readers.rtklib import read_tag
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import SAID, Channel, LogError, Sensor
from sensorfault.logs.units import to_si
from sensorfault.logs.validity import Validity

_NAMED = 6  # columns listed in one sentence
_ESTIMATE = 1.25  # ticks are those of an estimate only if it is faster than every sensor by this factor
_LOOK_ROWS = 100_000  # share of repeated rows that suggests a hold


@dataclass(frozen=True)
class Stream:
    """T rows of one file, C channels of its sensors.

    `zero_s`: the reading of the common clock at time 0 [s]. `period_s`: the usual time between two rows [s].
    `jumps`: of its clock, at times as `time` has them.
    `measured`: whether a channel of it is a measurement or an estimate.
    `pace_s`: the same, but longer where no tick of a log should be: where only an estimator or a state speaks.
    """

    name: str
    zero_s: float
    period_s: float
    time: Float[np.ndarray, " T"]
    value: Float[np.ndarray, "T C"]
    fresh: Bool[np.ndarray, "T C"]
    channels: tuple[Channel, ...]
    sensors: tuple[Sensor, ...]
    notes: tuple[str, ...]
    measured: bool = True
    jumps: tuple[Jump, ...] = ()

    @property
    def pace_s(self) -> float:
        kinds = {channel.kind for channel in self.channels}
        pace = self.period_s * (1.0 if "" in kinds else _ESTIMATE if self.measured else np.inf)
        return float(f"{pace:.6g}")  # of equally fast ones the first is taken, not the one rounded down


def read_stream(source: Source, file: FileEntry, sensors: tuple[SensorEntry, ...]) -> Stream:
    """The described sensors of one file.

    Raises:
        LogError: no time, a column that is missing, holds text or holds nothing.
    """
    clock = read_clock(source, file)
    zero, rate = clock.zero_s + file.offset_s, 1.0
    measured = any(channel.kind not in SAID for sensor in sensors for channel in sensor.channels)
    notes = [*source.notes, *(clock.notes if measured else ())]
    if file.tag is not None:
        counter = clock.zero_s + clock.time
        start, rate = read_tag(source.path.parent / file.tag, source.path, counter, clock.rows + source.first_line)
        zero = start + rate * clock.zero_s + file.offset_s
        notes.append(
            f"{source.name}: {file.tag} gives its counter GPS time; the counter runs "
            f"{abs(rate - 1) * 1e6:.1f} ppm {'slow' if rate > 1 else 'fast'}, which was corrected."
        )
    time = clock.time if rate == 1.0 else clock.time * rate
    gaps = _Gaps(source)
    channels = tuple(channel_of(c, s) for s in sensors for c in s.channels)
    value = np.empty((len(time), len(channels)))
    fresh = np.empty(value.shape, bool)
    described, at = [], 0
    for sensor in sensors:
        own = slice(at, at + len(sensor.channels))
        for i, channel in enumerate(sensor.channels, at):
            value[:, i] = _channel(source, channel, clock, gaps, sensor.period_s is not None)
        fresh[:, own] = _fresh(source, sensor, value[:, own], clock)
        period = sensor.period_s or usual_period_s(time, fresh[:, own], clock.period_s * rate)
        if sensor.held and sensor.epoch is not None:
            late = stale(time, fresh[:, own], period)
            value[late, own] = np.nan
            notes += _stale_note(source.name, sensor.name, late, period)
        described.append(Sensor(sensor.name, period, sensor.held))
        if any(channel.kind not in SAID for channel in sensor.channels):
            notes += _held_note(source.name, sensor, value[:, own], fresh[:, own], period)
        at = own.stop
    notes += gaps.notes()
    said = tuple(channels), tuple(described), tuple(notes), measured, clock.jumps
    return Stream(source.name, zero, clock.period_s * rate, time, value, fresh, *said)


def channel_of(channel: ChannelEntry, sensor: SensorEntry) -> Channel:
    """The channel that an entry describes."""
    return Channel(channel.name, sensor.name, channel.unit, channel.watch, channel.kind)


class _Gaps:
    """Collects cells without a usable number, for two sentences on the whole file."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.found: dict[str, list[tuple[str, int, int]]] = {}

    def see(self, what: str, column: str, bad: np.ndarray) -> None:
        if bad.any():
            self.found.setdefault(what, []).append((column, int(bad.sum()), int(np.argmax(bad))))

    def notes(self) -> list[str]:
        said = []
        for what, entries in self.found.items():
            names = ", ".join(f"'{column}' ({count})" for column, count, _ in entries[:_NAMED])
            if len(entries) > _NAMED:
                names += f" and {len(entries) - _NAMED} other columns"
            first = self.source.place(min(row for _, _, row in entries))
            said.append(f"{self.source.name}: cells {what} in {names}, first in {first}; read as no value.")
        return said


def _channel(source: Source, channel: ChannelEntry, clock: Clock, gaps: _Gaps, silent: bool) -> np.ndarray:
    """One column in SI on the kept rows, NaN without a value; `silent`: it may have no value at all."""
    value = source.column(channel.column).cast(pl.Float64).to_numpy()
    absent = ~np.isfinite(value)
    said = channel.kind in SAID
    if absent.any() and not said:
        empty = np.isnan(value)
        gaps.see("are infinite", channel.column, absent & ~empty)
        gaps.see("are empty", channel.column, empty)
    if channel.missing is not None:
        absent |= value == channel.missing
    if channel.valid is not None:
        condition = Validity.parse(channel.valid, f"{source.path}: column '{channel.column}' valid =")
        absent |= ~condition.holds(source.column(condition.column).cast(pl.Float64).fill_null(np.nan).to_numpy())
    elif absent.all() and not (silent or said):
        raise LogError(
            f"{source.path}: column '{channel.column}' holds no value at all; take it out of vehicle.toml, or write "
            "period_s into its sensor if the sensor was silent."
        )
    si: Float[np.ndarray, " T"] = to_si(value, channel.unit)
    if absent.any():
        si = np.where(absent, np.nan, si)
    return si if len(clock.rows) == len(si) else si[clock.rows]


def _fresh(source: Source, sensor: SensorEntry, value: np.ndarray, clock: Clock) -> np.ndarray:
    """Fresh marks of one sensor; a channel's own epoch column goes before the sensor's."""
    fresh = fresh_rows(value, sensor.held, _epoch(source, sensor.epoch, clock))
    for i, channel in enumerate(sensor.channels):
        if channel.epoch is not None:
            fresh[:, i : i + 1] = fresh_rows(value[:, i : i + 1], True, _epoch(source, channel.epoch, clock))
    return fresh


def _epoch(source: Source, name: str | None, clock: Clock) -> np.ndarray | None:
    """An epoch column as numbers that change when it does."""
    if name is None:
        return None
    column = source.any_column(name)
    if not column.dtype.is_numeric():
        column = column.rle_id().set(column.is_null(), None)
    epoch: Float[np.ndarray, " T"] = column.cast(pl.Float64).fill_null(np.nan).to_numpy()[clock.rows]
    return epoch


def _stale_note(file: str, sensor: str, late: np.ndarray, period_s: float) -> list[str]:
    if not late.any():
        return []
    return [
        f"{file}: sensor '{sensor}' had no new measurement for longer than {STALE * period_s:.3g} s at a time; "
        f"{int(late.sum())} rows that repeat its last measurement count as missing."
    ]


def _held_note(name: str, sensor: SensorEntry, value: np.ndarray, fresh: np.ndarray, period: float) -> list[str]:
    if sensor.held and not np.isfinite(period):
        return [f"{name}: sensor '{sensor.name}' is held, but has fewer than two measurements."]
    if sensor.held:
        share = share_old(value, fresh)
        return [
            f"{name}: sensor '{sensor.name}' is held: {share:.0%} of its rows repeat the last measurement, "
            f"a new one comes every {period:.3g} s."
        ]
    if looks_held(value[:_LOOK_ROWS]):
        share = share_repeated(value)
        return [
            f"{name}: {share:.0%} of the rows of sensor '{sensor.name}' repeat the row before, but count as new; "
            f"if the file repeats the last measurement, write held = true in [sensor.{sensor.name}]."
        ]
    return []
