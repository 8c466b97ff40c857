"""Fault events: when, which sensor, which channel, what kind."""

from dataclasses import asdict, dataclass
from typing import Any

from sensorfault.faults.fault import KINDS as FAULT_KINDS

KINDS = (*FAULT_KINDS, "unknown")


@dataclass(frozen=True)
class Event:
    """One fault, from its first faulty sample to its last.

    Args:
        start_s: time of the first faulty sample [s].
        end_s: time of the last one [s]; None while the fault is ongoing.
        subject: "sensor", or "motion" if healthy sensors measured a motion that the vehicle cannot make.
        sensor: name; None if the faulty sensor could not be isolated. For a kind "missing" without a sensor, nothing at
            all was recorded: a gap in the log.
        channel: name; None if all channels of the sensor are faulty. Channels that one test accuses together, such as
            latitude and longitude, are named together.
        kind: one of KINDS.
        peak_score: score of the test that exceeded its limit most, when it did. For a kind "missing", how long nothing
            was measured [s].
        limit: the limit of that test. For a kind "missing", how long a sensor may be silent [s].
        method: the recipe of the model.
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
