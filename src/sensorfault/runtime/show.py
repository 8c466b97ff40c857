"""A model and a detection in one line, and as small tables for notebooks."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Int8

from sensorfault.core import html
from sensorfault.core.times import clock
from sensorfault.core.verdicts import VERDICTS
from sensorfault.events.event import EVENT_HEADS, Event, event_cells
from sensorfault.logs.phrase import counted, listed, sensors_named, with_unit
from sensorfault.logs.table import Channel, Log, Sensor


def line(log: Log, method: str, events: Sequence[Event]) -> str:
    """`'drive': 3 events (2 offset, 1 frozen) in 1:40.00 by elm-autoencoder, sensors gyro, gnss`."""
    kinds = Counter(event.kind for event in events)
    by_kind = f" ({', '.join(f'{count} {kind}' for kind, count in kinds.most_common())})" if kinds else ""
    found = f"{counted(len(events), 'event')}{by_kind}"
    sensors = sensors_named([sensor.name for sensor in log.sensors])
    return f"{log.name!r}: {found} in {clock(log.duration_s)} by {method}, {sensors}"


def as_html(log: Log, method: str, events: Sequence[Event], verdict: Int8[np.ndarray, "T S"] | None) -> str:
    """The events, and each sensor's share of the time under each verdict, where the verdicts on rows were kept."""
    rows = []
    for i, sensor in enumerate(log.sensors if verdict is not None else ()):
        assert verdict is not None
        shares = [f"{np.mean(verdict[:, i] == code):.1%}" if len(log) else "" for code in range(len(VERDICTS))]
        rows.append((sensor.name, sum(event.sensor == sensor.name for event in events), *shares))
    found = [html.table(EVENT_HEADS, [event_cells(event) for event in events])] if events else []
    sensors = [html.table(("sensor", "events", *VERDICTS), rows)] if rows else []
    return html.page(f"Detection {line(log, method, events)}", *found, *sensors)


def comparison_line(sensors: Sequence[Sensor], summary: Mapping[str, Any]) -> str:
    """`auto fitted on 'drive' (1:40.00), sensors gyro, accelerometer, gnss`; `auto, not fitted`."""
    if not sensors:
        return "auto, not fitted: limits come from the log itself"
    seconds = summary.get("training_s")
    time = f" ({clock(seconds)})" if isinstance(seconds, float) else ""
    named = sensors_named([sensor.name for sensor in sensors])
    return f"auto fitted on {summary.get('training_log')!r}{time}, {named}"


def model_line(method: str, sensors: Sequence[Sensor], tick_s: float, summary: Mapping[str, Any]) -> str:
    """`elm-autoencoder fitted on 'drive' (1:40.00) at 50 Hz, sensors gyro, accelerometer, gnss`."""
    name, seconds = summary.get("training_log"), summary.get("training_s")
    where = f" on {name!r}" if name else ""
    time = f" ({clock(seconds)})" if isinstance(seconds, float) else ""
    return f"{method} fitted{where}{time} at {1 / tick_s:.3g} Hz, {sensors_named([sensor.name for sensor in sensors])}"


def model_html(
    title: str,
    channels: Sequence[Channel],
    sensors: Sequence[Sensor],
    watched: Sequence[bool],
    summary: Mapping[str, Any],
) -> str:
    """One row a sensor: which of its channels are judged; and what the held-out part said."""
    rows = []
    for sensor in sensors:
        words: dict[bool, list[str]] = {True: [], False: []}
        for channel, judged in zip(channels, watched, strict=True):
            if channel.sensor == sensor.name:
                words[bool(judged)].append(with_unit(channel.name, channel.unit))
        rows.append((sensor.name, listed(words[True]), listed(words[False])))
    tables = [html.table(("sensor", "judged", "only checked for dropouts"), rows)]
    if (alarms := summary.get("held_out_alarms")) is not None:
        tables.append(html.table(("held-out healthy data", "false alarms"), [(clock(summary["held_out_s"]), alarms)]))
    return html.page(f"Model {title}", *tables)
