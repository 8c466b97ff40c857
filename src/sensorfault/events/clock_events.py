"""Jumps of a log's clock as events: they accuse the clock, and no sensor."""

from collections.abc import Iterable

from sensorfault.events.event import CLOCK, JUMP, Event
from sensorfault.logs.table import Log


def clock_events(log: Log, method: str) -> tuple[Event, ...]:
    """One event for each jump of the clock between the first row of a log and its last; the peak is its size [s]."""
    if not len(log):
        return ()
    first, last = float(log.time[0]), float(log.time[-1])
    return tuple(
        Event(jump.time_s, jump.time_s, CLOCK, CLOCK, None, JUMP, jump.step_s, None, method, jump.said)
        for jump in log.jumps
        if first <= jump.time_s <= last
    )


def by_onset(*events: Iterable[Event]) -> tuple[Event, ...]:
    """All of them, in order of their start."""
    return tuple(sorted((event for some in events for event in some), key=lambda event: event.start_s))
