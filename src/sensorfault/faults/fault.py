"""What is done to a sensor: the truth against which a detection is judged."""

from dataclasses import asdict, dataclass
from typing import Any

KINDS = ("short", "bias", "drift", "jam", "miss", "noise", "scale", "delay")


@dataclass(frozen=True)
class Fault:
    """One injected fault.

    `channel` None means every channel of the sensor. `magnitude` is, by kind: short, bias: offset; drift: offset a
    second; noise: added standard deviation; scale: factor; delay: seconds; jam, miss: nothing. Offsets are in the
    channel's own unit, or with `sigmas` in multiples of the channel's standard deviation over the log.
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
        return self.start_s + self.duration_s

    def as_dict(self) -> dict[str, Any]:
        """For JSON; the keys are the fields."""
        return asdict(self)
