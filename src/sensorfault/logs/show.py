"""A log in one line, and as a small table for notebooks."""

from typing import TYPE_CHECKING

import numpy as np

from sensorfault.core import html
from sensorfault.core.clock import clock
from sensorfault.logs.phrase import counted, listed

if TYPE_CHECKING:
    from sensorfault.logs.table import Channel, Log


def line(log: "Log") -> str:
    """`'drive': 5,000 rows in 1:40.00 at 50 Hz, sensors gyro, accelerometer, gnss`."""
    rate = f" at {1 / log.period_s:.3g} Hz" if len(log) > 1 else ""
    rows = counted(len(log), "row")
    return f"{log.name!r}: {rows} in {clock(log.duration_s)}{rate}, {sensors(log)}"


def sensors(log: "Log") -> str:
    """`sensors gyro, gnss`: the names, of many the first."""
    names = [sensor.name for sensor in log.sensors]
    return f"{'sensor' if len(names) == 1 else 'sensors'} {listed(names) or 'none'}"


def as_html(log: "Log") -> str:
    """One row a sensor: channels with their units, how often it measures, how much is missing."""
    rows = []
    for sensor in log.sensors:
        columns = list(log.of(sensor.name))
        fresh, due = (
            log.fresh[:, columns],
            1.0 if not sensor.period_s > log.period_s else log.period_s / sensor.period_s,
        )
        share = float(fresh.mean()) / due if fresh.size else 0.0
        every = f"{sensor.period_s:.3g} s" if np.isfinite(sensor.period_s) else ""
        channels = listed([channel_words(log.channels[i]) for i in columns])
        rows.append((sensor.name, channels, every, "yes" if sensor.held else "", f"{min(1.0, share):.0%}"))
    heads = ("sensor", "channels", "every", "held", "received")
    notes = html.table(("notes",), [(note,) for note in log.notes]) if log.notes else ""
    return html.page(f"Log {line(log)}", html.table(heads, rows), notes)


def channel_words(channel: "Channel") -> str:
    """`x [deg/s]`."""
    return f"{channel.name} [{channel.unit}]" if channel.unit else channel.name
