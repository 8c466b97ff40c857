"""One event for several channels: those that one test accuses together, and all of a sensor that show the same."""

from dataclasses import dataclass, replace

from sensorfault.events.event import Event
from sensorfault.runtime.event_context import Accused, EventContext
from sensorfault.runtime.model import TOGETHER


@dataclass(frozen=True)
class Found:
    """A fault that has ended, or that is reported while it goes on."""

    accused: Accused
    last_s: float  # of its last accusation
    size: float  # root mean square of its residual [SI]
    event: Event

    @property
    def column(self) -> int:
        """The channel accused."""
        assert isinstance(self.accused, int)
        return self.accused

    @property
    def excess(self) -> float:
        """Score over limit."""
        return (self.event.peak_score or 0.0) / (self.event.limit or 1.0)


def joined(found: list[Found], context: EventContext) -> list[Event]:
    """The events of these faults, one for each group of channels that are faulty in the same way.

    A group is what one test accuses, if its faults begin and end together; or a whole sensor, if all of its channels
    show the same kind of fault.
    """
    events = [one.event for one in found]
    if len(found) < 2:
        return events
    columns = context.columns
    whole = [tuple(mine) for mine in columns.values()]
    tested = [test for test in context.tests if isinstance(test, tuple) and len(test) > 1]
    for group in dict.fromkeys([*whole, *tested]):
        mine = [one for one in found if one.accused in group]
        if len(mine) < len(group) or len(group) < 2:
            continue
        sensor = len(group) == len(columns[context.sensor[group[0]]])
        same = sensor and len({one.event.kind for one in mine}) == 1
        alike = group in tested and len({(one.event.start_s, one.last_s) for one in mine}) == 1
        if same or alike:
            events = [event for event in events if not any(event is one.event for one in mine)]
            events.append(_one(mine, sensor, context))
    return events


def _one(mine: list[Found], sensor: bool, context: EventContext) -> Event:
    """The event of several channels of one sensor, or of all of it: its kind is that of the clearest."""
    worst = max(mine, key=lambda one: one.excess).event
    clearest = max(mine, key=lambda one: one.size / float(context.sigma[one.column]))
    return replace(
        worst,
        start_s=min(one.event.start_s for one in mine),
        channel=None if sensor else TOGETHER.join(context.channel[one.column] for one in mine),
        kind="frozen" if any(one.event.kind == "frozen" for one in mine) else clearest.event.kind,
    )
