"""Columns that follow from an autopilot's own: rates from integrals, what a state or an event number means."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import polars as pl

from sensorfault.logs.readers.source import Source

ARMED, LANDED = "armed", "landed"
_US = 1e6
_ARMED_BIT = 128  # MAV_MODE_FLAG_SAFETY_ARMED
_ON_GROUND = 1  # MAV_LANDED_STATE_ON_GROUND
_PX4_ARMED = 2  # vehicle_status.ARMING_STATE_ARMED
_EVENTS = {ARMED: {10: 1.0, 11: 0.0}, LANDED: {18: 1.0, 28: 0.0}}  # ArduPilot's LogEvent


@dataclass(frozen=True)
class _Rule:
    """Of tables that have the columns `of` (and this name): new columns."""

    of: tuple[str, ...]
    new: Callable[[], list[pl.Expr]]
    table: str = ""


def _rates(of: str, over: str, names: str = "012") -> _Rule:
    """What was integrated over some µs -> `rate_of_...`, a second."""
    columns = tuple(of.format(name) for name in names)
    return _Rule((*columns, over), lambda: [(pl.col(c) * _US / pl.col(over)).alias(f"rate_of_{c}") for c in columns])


def _is(column: str, number: int, name: str) -> list[pl.Expr]:
    return [(pl.col(column) == number).cast(pl.Float64).alias(name)]


def _event(name: str) -> pl.Expr:
    found = pl.col("Id").replace_strict(_EVENTS[name], default=None, return_dtype=pl.Float64)
    return found.forward_fill().fill_null(float("nan")).alias(name)


_RULES = (
    _rates("delta_angle[{}]", "delta_angle_dt"),  # PX4's vehicle_imu
    _rates("delta_velocity[{}]", "delta_velocity_dt"),
    _rates("pixel_flow[{}]", "integration_timespan_us", "01"),
    _rates("pixel_flow_{}_integral", "integration_timespan", "xy"),
    _rates("integrated_{}", "integration_time_us", "xy"),  # MAVLink's OPTICAL_FLOW_RAD
    _Rule(("arming_state", "nav_state"), lambda: _is("arming_state", _PX4_ARMED, ARMED)),
    _Rule(("base_mode", "custom_mode"), lambda: [(pl.col("base_mode") // _ARMED_BIT % 2).alias(ARMED)]),
    _Rule(("vtol_state", "landed_state"), lambda: _is("landed_state", _ON_GROUND, LANDED)),
    _Rule(("Id",), lambda: [_event(name) for name in _EVENTS], "EV"),
)


def with_columns(source: Source) -> Source:
    """The same table with the columns that follow from its own."""
    frame = source.frame
    for rule in _RULES:
        if rule.table in ("", source.table) and all(
            name in frame.columns and frame[name].dtype.is_numeric() for name in rule.of
        ):
            frame = frame.with_columns(rule.new())
    return source if frame is source.frame else replace(source, frame=frame)
