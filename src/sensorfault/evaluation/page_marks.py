"""Where the faults are to be marked in a plot, and how far a plot reaches."""

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Bool

from sensorfault.detection import Detection
from sensorfault.evaluation.page_figure import Mark
from sensorfault.evaluation.page_lines import Span, near
from sensorfault.evaluation.page_words import found
from sensorfault.events import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Channel, Log
from sensorfault.model import TOGETHER

NUMBERED = 100  # events; of more, the numbers would only be a smear


def whole(log: Log) -> Span:
    """The time from the first tick to the last, never empty [s]."""
    if not len(log):
        return 0.0, 1.0
    first, last = float(log.time[0]), float(log.time[-1])
    return (first, last) if last > first else (first - 0.5, last + 0.5)


def _span(event: Event, log: Log) -> Span:
    return event.start_s, whole(log)[1] if event.end_s is None else event.end_s


def kept(detection: Detection, budget: int) -> Bool[np.ndarray, " T"]:
    """Ticks that every line draws: those around the events."""
    return near(detection.log.time, [_span(event, detection.log) for event in detection.events], budget)


def shades(detection: Detection, concerns: Callable[[Event], bool]) -> list[Mark]:
    """The events a plot is concerned with, numbered as in the table."""
    numbered = len(detection.events) <= NUMBERED
    return [
        Mark(_span(event, detection.log), "--shade", str(i) if numbered else "")
        for i, event in enumerate(detection.events, 1)
        if concerns(event)
    ]


def at(event: Event, channel: Channel) -> bool:
    """Whether an event is, or may be, about this channel."""
    return event.sensor in (None, channel.sensor) and (
        event.channel is None or channel.name in event.channel.split(TOGETHER)
    )


def injected(detection: Detection, channel: Channel, truth: Sequence[Fault]) -> list[Mark]:
    """The injected faults of a channel: a line along the top, dotted where it was missed."""
    return [
        Mark((f.start_s, f.end_s), "--truth", line="solid" if found(f, detection.events) else "dot")
        for f in truth
        if f.sensor == channel.sensor and f.channel in (None, channel.name, channel.path)
    ]
