"""Fault events: when, which sensor, which channel, what kind."""

from dataclasses import asdict, dataclass
from typing import Any

from sensorfault.core import html
from sensorfault.core.clock import clock
from sensorfault.faults.fault import KINDS as FAULT_KINDS

KINDS = (*FAULT_KINDS, "unknown")
NOBODY = "unknown which"


@dataclass(frozen=True)
class Event:
    """One fault, from its first faulty sample to its last.

    `subject`: "sensor", or "motion" when healthy sensors saw a vehicle do what it cannot. `sensor` and `channel` are
    None where the fault could not be laid at one door; `channel` alone, where all of a sensor's channels are faulty.
    Channels that one test accuses together (latitude and longitude) are named together.
    A miss without a sensor is a gap in the log itself: nothing was recorded.
    `end_s` is None while the fault lasts. `peak_score` and `limit` belong to the test that exceeded its limit most,
    `method` to the recipe that says so; a miss has no score, its peak is the silence and its limit the silence allowed
    [s].
    """

    start_s: float
    end_s: float | None
    subject: str
    sensor: str | None
    channel: str | None
    kind: str
    peak_score: float | None
    limit: float | None
    method: str

    def as_dict(self) -> dict[str, Any]:
        """For JSON; the keys are the fields."""
        return asdict(self)

    @property
    def where(self) -> str:
        """Whose the fault is: `gnss.altitude`, `gnss`, `vehicle motion`, or nobody's."""
        if self.subject == "motion":
            return "vehicle motion"
        if self.sensor is None:
            return "the whole log" if self.kind == "missing" else NOBODY
        return f"{self.sensor}.{self.channel}" if self.channel else self.sensor

    def __str__(self) -> str:
        end = "-ongoing" if self.end_s is None else f"-{clock(self.end_s)}" if self.end_s > self.start_s else ""
        sizes = (("peak", self.peak_score), ("limit", self.limit))
        unit = " s" if self.kind == "missing" else ""
        size = ", ".join(f"{name} {value:.3g}{unit}" for name, value in sizes if value is not None)
        kind = "fault" if self.kind == "unknown" else self.kind
        of = f", {NOBODY}" if self.where == NOBODY else f" of {self.where}"
        return f"{clock(self.start_s)}{end} {kind}{of}" + (f" ({size})" if size else "")

    def __repr__(self) -> str:
        return f"<Event {self}>"

    def _repr_html_(self) -> str:
        return html.table(EVENT_HEADS, [event_cells(self)])


EVENT_HEADS = ("start", "end", "where", "kind", "peak", "limit", "method")


def event_cells(event: Event) -> tuple[str, ...]:
    """One event as a row under EVENT_HEADS."""
    end = "ongoing" if event.end_s is None else clock(event.end_s)
    sizes = html.number(event.peak_score), html.number(event.limit)
    return clock(event.start_s), end, event.where, event.kind, *sizes, event.method
