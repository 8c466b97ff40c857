"""A model and a detection in one line, and as small tables for notebooks."""

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from sensorfault.core import html
from sensorfault.core.clock import clock
from sensorfault.core.types import VERDICTS
from sensorfault.events.event import EVENT_HEADS, event_cells
from sensorfault.logs.phrase import counted, listed
from sensorfault.logs.show import channel_words, sensors

if TYPE_CHECKING:
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection

_HEADS = ("sensor", "events", *VERDICTS)


def line(found: "Detection") -> str:
    """`'drive': 3 events (2 offset, 1 frozen) in 1:40.00 by elm-autoencoder, sensors gyro, gnss`."""
    kinds = Counter(event.kind for event in found.events)
    by_kind = f" ({', '.join(f'{count} {kind}' for kind, count in kinds.most_common())})" if kinds else ""
    events = f"{counted(len(found.events), 'event')}{by_kind}"
    return f"{found.log.name!r}: {events} in {clock(found.log.duration_s)} by {found.method}, {sensors(found.log)}"


def as_html(found: "Detection") -> str:
    """The events, and each sensor's share of the time under each verdict."""
    events = html.table(EVENT_HEADS, [event_cells(event) for event in found.events]) if found.events else ""
    rows = []
    for i, sensor in enumerate(found.log.sensors):
        verdict = found.sensor[:, i]
        shares = [f"{np.mean(verdict == code):.1%}" if len(verdict) else "" for code in range(len(VERDICTS))]
        events_of = sum(event.sensor == sensor.name for event in found.events)
        rows.append((sensor.name, events_of, *shares))
    return html.page(f"Detection {line(found)}", events, html.table(_HEADS, rows))


def model_line(model: "Model") -> str:
    """`elm-autoencoder fitted on 'drive' (1:40.00) at 50 Hz, sensors gyro, accelerometer, gnss`."""
    of, seconds = model.summary.get("training_log"), model.summary.get("training_s")
    where = f" on {of!r}" if of else ""
    time = f" ({clock(seconds)})" if isinstance(seconds, float) else ""
    names = [sensor.name for sensor in model.sensors]
    word = "sensor" if len(names) == 1 else "sensors"
    return f"{model.method} fitted{where}{time} at {1 / model.tick_s:.3g} Hz, {word} {listed(names)}"


def model_html(model: "Model") -> str:
    """One row a sensor: which of its channels are judged, and the spread of their healthy residuals."""
    rows = []
    for sensor in model.sensors:
        mine = [i for i, channel in enumerate(model.channels) if channel.sensor == sensor.name]
        judged = [channel_words(model.channels[i]) for i in mine if model.watched[i]]
        others = [channel_words(model.channels[i]) for i in mine if not model.watched[i]]
        rows.append((sensor.name, listed(judged), listed(others)))
    tables = [html.table(("sensor", "judged", "only checked for dropouts"), rows)]
    if (alarms := model.summary.get("held_out_alarms")) is not None:
        held_out = clock(model.summary["held_out_s"])
        tables.append(html.table(("held-out healthy data", "false alarms"), [(held_out, alarms)]))
    return html.page(f"Model {model_line(model)}", *tables)
