"""The columns of a log that describe a vehicle under water and its leaders."""

from typing import NamedTuple

from sensorfault.logs.table import Channel, Log
from sensorfault.logs.units import si_unit

_POSITIONS = (("latitude", "longitude", "rad"), ("north", "east", "m"), ("y", "x", "m"))


class LeaderColumns(NamedTuple):
    """As `underwater.Leader`."""

    range: int
    position: tuple[int, ...]
    depth: int | None


class FollowerColumns(NamedTuple):
    """As `underwater.FollowerRoles`."""

    leaders: tuple[LeaderColumns, ...]
    position: tuple[int, ...]
    velocity: tuple[int, ...]
    heading: int | None
    depth: int | None
    geodetic: bool


def follower_columns(log: Log) -> FollowerColumns:
    """A leader is a sensor with a `range` [m] and a position; other roles: the first channel with each name and unit.

    A position is `latitude` and `longitude`, or `north` and `east` or `y` and `x` in metres, all of one kind.
    """
    sensors = list(dict.fromkeys(c.sensor for c in log.channels))
    for northward, eastward, unit in _POSITIONS:
        placed = {s: _position(log, s, northward, eastward, unit) for s in sensors}
        ranges = {s: _named(log.channels, ("range",), "m", s) for s in sensors}
        leaders = tuple(
            LeaderColumns(ranges[s], placed[s], _named(log.channels, ("depth",), "m", s))  # type: ignore[arg-type]
            for s in sensors
            if ranges[s] is not None and placed[s]
        )
        if leaders:
            break
    ahead = _named(log.channels, ("forward", "surge"), "m/s")
    aside = _named(log.channels, ("right", "starboard"), "m/s")
    others = [s for s in sensors if ranges[s] is None]
    return FollowerColumns(
        leaders=leaders,
        position=next((placed[s] for s in others if placed[s]), ()),
        velocity=() if ahead is None or aside is None else (ahead, aside),
        heading=_named(log.channels, ("heading", "yaw"), "rad"),
        depth=next((d for s in others if (d := _named(log.channels, ("depth",), "m", s)) is not None), None),
        geodetic=unit == "rad",
    )


def _named(channels: tuple[Channel, ...], names: tuple[str, ...], unit: str, sensor: str | None = None) -> int | None:
    found = (
        i for i, c in enumerate(channels) if c.name in names and si_unit(c.unit) == unit and sensor in (None, c.sensor)
    )
    return next(found, None)


def _position(log: Log, sensor: str, northward: str, eastward: str, unit: str) -> tuple[int, ...]:
    both = [_named(log.channels, (name,), unit, sensor) for name in (northward, eastward)]
    return () if None in both else tuple(both)  # type: ignore[arg-type]
