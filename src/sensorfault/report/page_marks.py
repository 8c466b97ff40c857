"""The marks of faults in a plot."""

from collections.abc import Callable, Sequence

from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Channel
from sensorfault.report.page_figure import Mark
from sensorfault.report.page_lines import Span
from sensorfault.report.page_sketch import Sketch
from sensorfault.report.page_words import found
from sensorfault.runtime.model import TOGETHER

NUMBERED = 100  # events; the numbers of more would overlap


def _span(event: Event, sketch: Sketch) -> Span:
    return event.start_s, sketch.span[1] if event.end_s is None else event.end_s


def shades(sketch: Sketch, concerns: Callable[[Event], bool]) -> list[Mark]:
    """Shades for the events that concern a plot, numbered as in the table."""
    numbered = len(sketch.events) <= NUMBERED
    return [
        Mark(_span(event, sketch), "--shade", str(i) if numbered else "")
        for i, event in enumerate(sketch.events, 1)
        if concerns(event)
    ]


def at(event: Event, channel: Channel) -> bool:
    """Whether an event accuses this channel, or may be its fault."""
    return event.sensor in (None, channel.sensor) and (
        event.channel is None or channel.name in event.channel.split(TOGETHER)
    )


def injected(sketch: Sketch, channel: Channel, truth: Sequence[Fault]) -> list[Mark]:
    """The injected faults of a channel: a line along the top, dotted for a fault that was missed."""
    return [
        Mark((f.start_s, f.end_s), "--truth", line="solid" if found(f, sketch.events) else "dot")
        for f in truth
        if f.sensor == channel.sensor and f.channel in (None, channel.name, channel.path)
    ]
