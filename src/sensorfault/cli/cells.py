"""Numbers, events and faults as the cells of a table."""

import math
from typing import TYPE_CHECKING

from sensorfault.core.times import clock

if TYPE_CHECKING:
    from sensorfault.events.event import Event
    from sensorfault.faults.fault import Fault

EVENT_COLUMNS = ("start", "end", "sensor", "channel", "kind", "peak", "limit")


def number(value: float | None, digits: int = 3) -> str:
    """A few digits; nothing for None and NaN."""
    return "" if value is None or not math.isfinite(value) else f"{value:.{digits}g}"


def percent(value: float) -> str:
    """A share as a whole percentage; nothing for NaN."""
    return "" if not math.isfinite(value) else f"{100 * value:.0f}"


def event_row(event: "Event") -> tuple[str, ...]:
    """One event, a cell for each of EVENT_COLUMNS."""

    channel = event.channel or ("" if event.sensor is None else "all")
    times = clock(event.start_s), "ongoing" if event.end_s is None else clock(event.end_s)
    return (*times, event.accused, channel, event.kind, number(event.peak_score), number(event.limit))


def fault_words(fault: "Fault") -> str:
    """An injected fault in a few words: `offset 5 sigma on gyro.z`."""
    from sensorfault.faults.fault import SIZELESS

    unit = " sigma" if fault.sigmas else ""
    size = "" if fault.kind in SIZELESS else f" {fault.magnitude:g}{unit}"
    return f"{fault.kind}{size} on {fault.where}"
