"""Which channels are one device: values that a receiver or an attitude filter sends together are one sensor."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from jaxtyping import Bool, Float

from sensorfault.logs.clock import Clock
from sensorfault.logs.guess.columns import Column
from sensorfault.logs.guess.words import read_name
from sensorfault.logs.held import changes, fresh_rows, looks_held, repeats, share_old, usual_period_s
from sensorfault.logs.readers.source import Source

_DEVICES: tuple[tuple[str, str, tuple[str, ...]], ...] = (  # name, the part that leads, the parts that may come with it
    ("gnss", "gnss_position", ("gnss_speed", "gnss_velocity", "gnss_course", "gnss_height")),
    ("attitude", "attitude", ("heading",)),
)
_TRACK = {"course", "track"}  # where a vehicle goes, not where its nose points: no part of an attitude
_TOGETHER = 0.9  # share of one's arrivals that must be the other's too
_SAME_PERIOD = 0.1
_SLACK, _STEADY = 0.25, 0.7  # a pace is steady if more than this share of the steps is this near to the usual


@dataclass(frozen=True)
class Delivery:
    """How measurements arrive. `arrived`: rows with a new one; `old`: share of the rows with a value that repeat it."""

    held: bool
    epoch: str | None
    arrived: Bool[np.ndarray, " T"]
    period_s: float
    old: float


@dataclass(frozen=True)
class Device:
    """What one sensor is made of."""

    name: str
    columns: list[Column]
    delivery: Delivery


def find_devices(parts: Mapping[str, list[Column]], source: Source, clock: Clock) -> list[Device]:
    """One device for each part, or for several that are one receiver's and come together.

    An epoch column shows when a receiver sent a measurement. Without one, a change of any channel counts as a new
    measurement of all, so parts that come in rows of their own or at other rates become sensors of their own.
    """
    found = {name: Device(name, columns, _delivery(columns, source, clock)) for name, columns in parts.items()}
    for name, lead, others in _DEVICES:
        if lead not in found:  # a receiver without a position: the first of what it has leads
            there = [part for part in others if part in found]
            if name != "gnss" or not there:
                continue
            lead, others = there[0], tuple(there[1:])
        leader = found[lead]
        joined = [part for part in others if part in found and _together(leader, found[part])]
        order = [part for part in found if part == lead or part in joined]
        columns = [column for part in order for column in found[part].columns]
        whole = Device(name, columns, leader.delivery)
        found = {part: whole if part == order[0] else one for part, one in found.items() if part not in order[1:]}
    return list(found.values())


def _together(leader: Device, part: Device) -> bool:
    """Whether a part comes with the leader of its device."""
    if leader.name == "attitude" and _TRACK & {column.meaning.axis for column in part.columns}:
        return False
    first, other = leader.delivery, part.delivery
    if not first.held:
        return not other.held and _share(first.arrived, other.arrived) and _share(other.arrived, first.arrived)
    paced = other.held and _is_steady(
        other.arrived
    )  # has a rate of its own; a coarse reading lasts now long, now short
    if paced and (first.epoch or other.epoch):
        return first.epoch == other.epoch
    value = np.column_stack([column.value for column in part.columns])
    moved = ~repeats(value) & np.isfinite(value).any(axis=1)
    if first.epoch is not None:  # a coarse reading may stay as it is, but never changes twice between two fixes
        changed = np.bincount(np.cumsum(first.arrived), moved)
        return _share(changed > 0, changed == 1)
    if paced and abs(other.period_s - first.period_s) > _SAME_PERIOD * first.period_s:
        return False
    return _share(moved, first.arrived)


def _is_steady(arrived: Bool[np.ndarray, " T"]) -> bool:
    """Whether most measurements last for as many rows as usual."""
    lasts = np.diff(np.flatnonzero(arrived))
    return len(lasts) > 0 and bool(np.mean(np.abs(lasts / np.median(lasts) - 1) <= _SLACK) > _STEADY)


def _share(these: Bool[np.ndarray, " K"], those: Bool[np.ndarray, " K"]) -> bool:
    """Whether nearly all of these are among those."""
    return bool((these & those).sum() >= _TOGETHER * these.sum())


def _delivery(columns: Sequence[Column], source: Source, clock: Clock) -> Delivery:
    value = np.column_stack([column.value for column in columns])
    held = looks_held(value) or all(looks_held(channel[:, None]) for channel in value.T)
    epoch = _epoch(source, value, clock) if held else None
    fresh = fresh_rows(value, held, None if epoch is None else _reading(source.frame[epoch], clock))
    arrived: Bool[np.ndarray, " T"] = np.any(fresh, axis=1)
    return Delivery(held, epoch, arrived, usual_period_s(clock.time, fresh, clock.period_s), share_old(value, fresh))


def _epoch(source: Source, value: Float[np.ndarray, "T C"], clock: Clock) -> str | None:
    """A time or sequence column that changes as often as the held sensor's most active channel, or slightly more."""
    moved = max(int((~repeats(channel[:, None])).sum()) for channel in value.T)
    best: tuple[float, str] | None = None
    for name in source.frame.columns:
        column = source.frame[name]
        if read_name(name).kind != "time" or not column.dtype.is_numeric():
            continue
        reading = _reading(column, clock)
        ratio = float(changes(reading).sum()) / max(moved, 1)
        rising = np.nanmin(np.diff(reading), initial=0.0) >= 0
        if rising and 0.95 < ratio < 2.0 and (best is None or ratio < best[0]) and not _of_the_rows(reading):
            best = ratio, name
    return best[1] if best else None


def _reading(column: pl.Series, clock: Clock) -> Float[np.ndarray, " T"]:
    reading: Float[np.ndarray, " T"] = column.cast(pl.Float64).fill_null(np.nan).to_numpy()[clock.rows]
    return reading


def _of_the_rows(reading: Float[np.ndarray, " T"]) -> bool:
    """Whether a column changes in nearly every row: a clock of the rows, not of the measurements."""
    return float(changes(reading).mean()) > 0.9
