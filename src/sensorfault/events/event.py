"""Fault events: when, which sensor, which channel, what kind."""

from dataclasses import asdict, dataclass
from typing import Any

from sensorfault.faults.fault import KINDS as FAULT_KINDS

KINDS = (*FAULT_KINDS, "unknown")


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
