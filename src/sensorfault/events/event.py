"""Fault events: when, which sensor, which channel, what kind."""

from dataclasses import asdict, dataclass
from typing import Any

from sensorfault.core import html
from sensorfault.core.times import clock
from sensorfault.faults.fault import KINDS as FAULT_KINDS

JUMP = "jump"  # of the clock
KINDS = (*FAULT_KINDS, "unknown", JUMP)
CLOCK = "clock"
MOTION = "vehicle motion"
WHOLE_LOG = "the whole log"  # nothing was recorded
UNKNOWN = "unknown which"  # no sensor could be isolated


@dataclass(frozen=True)
class Event:
    """One fault, from its first faulty sample to its last.

    Args:
        start_s: time of the first faulty sample [s].
        end_s: time of the last one [s]; None while the fault is ongoing.
        subject: "sensor"; "motion" if healthy sensors measured a motion that the vehicle cannot make; "clock" if the
            clock of the log jumped, which is no sensor's fault: `sensor` is "clock" too.
        sensor: name; None if the faulty sensor could not be isolated. For a kind "missing" without a sensor, nothing at
            all was recorded: a gap in the log.
        channel: name; None if all channels of the sensor are faulty. Channels that one test accuses together, such as
            latitude and longitude, are named together.
        kind: one of KINDS.
        peak_score: score of the test that exceeded its limit most, when it did. For a kind "missing", how long nothing
            was measured [s]. For a kind "jump", how far the clock was set, negative if back [s].
        limit: the limit of that test. For a kind "missing", how long a sensor may be silent [s].
        method: the recipe of the model.
        found_by: the comparison that found it, where a method names it: "gnss.height | barometer over 15 s".
        candidates: where the sensor could not be isolated, those that explain what was measured, likeliest first.
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
    found_by: str | None = None
    candidates: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """For JSON; the keys are the fields."""
        return {**asdict(self), "candidates": list(self.candidates)}

    @property
    def accused(self) -> str:
        """The sensor's name, or one of MOTION, WHOLE_LOG, UNKNOWN."""
        if self.subject == "motion":
            return MOTION
        return self.sensor or (WHOLE_LOG if self.kind == "missing" else self._unknown)

    @property
    def _unknown(self) -> str:
        return f"{UNKNOWN}: {' or '.join(self.candidates)}" if self.candidates else UNKNOWN

    @property
    def where(self) -> str:
        """`gnss.altitude` or `gnss`, or one of MOTION, WHOLE_LOG, UNKNOWN."""
        return f"{self.sensor}.{self.channel}" if self.sensor and self.channel else self.accused

    def __str__(self) -> str:
        end = "-ongoing" if self.end_s is None else f"-{clock(self.end_s)}" if self.end_s > self.start_s else ""
        sizes: tuple[tuple[str, float | None], ...] = (("peak", self.peak_score), ("limit", self.limit))
        unit = " s" if self.kind in ("missing", JUMP) else ""
        sizes = (("size", self.peak_score),) if self.kind == JUMP else sizes
        size = ", ".join(f"{name} {value:.3g}{unit}" for name, value in sizes if value is not None)
        kind = "fault" if self.kind == "unknown" else self.kind
        of = f", {self.where}" if self.where.startswith(UNKNOWN) else f" of {self.where}"
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
