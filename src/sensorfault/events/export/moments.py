"""The moments at which events begin and end, on the recording's clock."""

from collections.abc import Sequence
from dataclasses import dataclass

from sensorfault.events.event import Event
from sensorfault.logs.table import Log

NS = 10**9


@dataclass(frozen=True)
class Moment:
    """When an event begins or ends.

    `time_ns`: Unix time if the log knows it, else since the log's zero [ns]. `open`: the events that are ongoing then,
    in order of their start.
    """

    time_ns: int
    event: Event
    begins: bool
    open: tuple[Event, ...]


def moments(events: Sequence[Event], log: Log) -> list[Moment]:
    """Every start and end in order of time; at the same time, ends come first. An ongoing event has no end."""
    zero = log.epoch_s or 0.0
    result = [(event.start_s, True, event) for event in events]
    result += [(event.end_s, False, event) for event in events if event.end_s is not None]
    last: list[Event] = []
    found = []
    for time_s, begins, event in sorted(result, key=lambda one: (one[0], one[1] and one[2].end_s != one[0])):
        last = [*last, event] if begins else [other for other in last if other is not event]
        found.append(Moment(round(zero * NS) + round(time_s * NS), event, begins, tuple(last)))
    return found


def sentence(event: Event, begins: bool) -> str:
    """`offset on gnss.altitude begins (score 12.3, limit 8.4, drone)`."""
    score = f"score {event.peak_score:.3g}, " if event.peak_score is not None else ""
    limit = f"limit {event.limit:.3g}, " if event.limit is not None else ""
    return f"{event.kind} on {event.where} {'begins' if begins else 'ends'} ({score}{limit}{event.method})"
