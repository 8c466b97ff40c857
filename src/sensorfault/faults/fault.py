"""What is done to a sensor: the truth against which a detection is judged."""

from dataclasses import asdict, dataclass
from typing import Any

KINDS = ("short", "bias", "drift", "jam", "miss", "noise", "scale", "delay")
OFFSETS = ("short", "bias", "drift", "noise")  # their magnitude carries the channel's unit, or counts its sigmas
SIZELESS = ("jam", "miss")  # they have no magnitude


class FaultError(ValueError):
    """A fault that cannot be injected or read. One sentence: what is wrong, where, and what to do."""


@dataclass(frozen=True)
class Fault:
    """One injected fault, acting on the measurements with start_s <= time < end_s.

    `channel` None means every channel of the sensor. `magnitude` is, by kind: short, bias: offset; drift: offset a
    second; noise: added standard deviation; scale: factor; delay: seconds; jam, miss: nothing. Offsets are in the
    channel's own unit, or with `sigmas` in multiples of the channel's standard deviation over the log. A short of
    `duration_s` 0 is one spike; every other kind lasts.
    """

    kind: str
    sensor: str
    channel: str | None
    start_s: float
    duration_s: float
    magnitude: float = 0.0
    sigmas: bool = False

    @property
    def end_s(self) -> float:
        """When the sensor is healthy again [s]."""
        return self.start_s + self.duration_s

    @property
    def where(self) -> str:
        """`sensor.channel`, or `sensor` where all its channels are hit."""
        return self.sensor if self.channel is None else f"{self.sensor}.{self.channel}"

    def as_dict(self) -> dict[str, Any]:
        """For JSON; the keys are the fields."""
        return asdict(self)
