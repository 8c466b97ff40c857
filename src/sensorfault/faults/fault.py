"""An injected fault: the truth against which a detection is judged."""

from dataclasses import asdict, dataclass
from typing import Any

from sensorfault.core import html
from sensorfault.core.times import clock

KINDS = ("spike", "offset", "drift", "frozen", "missing", "noise", "scale", "delay")
OFFSETS = ("spike", "offset", "drift", "noise")  # magnitude in the channel's unit, or in sigmas
SIZELESS = ("frozen", "missing")  # no magnitude
FORMER_KINDS = {"short": "spike", "bias": "offset", "jam": "frozen", "miss": "missing"}  # the names until version 0.1


def current_kind(name: str) -> str:
    """The current name of a kind; an unknown name is returned unchanged."""
    return FORMER_KINDS.get(name, name)


class FaultError(ValueError):
    """A fault that cannot be injected or read. One sentence: what is wrong, where, and what to do."""


@dataclass(frozen=True)
class Fault:
    """One injected fault, acting on the measurements with start_s <= time < end_s.

    `channel` None means every channel of the sensor. `magnitude` is, by kind: spike, offset: the offset; drift: offset
    per second; noise: added standard deviation; scale: factor; delay: seconds; frozen, missing: none. Offsets are in
    the channel's own unit, or with `sigmas` in multiples of the channel's standard deviation over the log. A spike of
    `duration_s` 0 is one sample; every other kind needs a duration. A former name of a kind (FORMER_KINDS) is accepted.
    """

    kind: str
    sensor: str
    channel: str | None
    start_s: float
    duration_s: float
    magnitude: float = 0.0
    sigmas: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "kind", current_kind(self.kind))

    @property
    def end_s(self) -> float:
        """When the sensor is healthy again [s]."""
        return self.start_s + self.duration_s

    @property
    def where(self) -> str:
        """`sensor.channel`, or `sensor` where all its channels are affected."""
        return self.sensor if self.channel is None else f"{self.sensor}.{self.channel}"

    def as_dict(self) -> dict[str, Any]:
        """For JSON; the keys are the fields."""
        return asdict(self)

    @property
    def size(self) -> str:
        """The magnitude as a person writes it, empty for a kind without one."""
        if self.kind in SIZELESS:
            return ""
        unit = {"scale": "x", "delay": " s"}.get(self.kind, " sigma" if self.sigmas else "")
        return f"{self.magnitude:g}{unit}"

    def __str__(self) -> str:
        span = clock(self.start_s) + (f"-{clock(self.end_s)}" if self.duration_s else "")
        return f"{span} {self.kind} of {self.where}" + (f" ({self.size})" if self.size else "")

    def __repr__(self) -> str:
        return f"<Fault {self}>"

    def _repr_html_(self) -> str:
        row = clock(self.start_s), clock(self.end_s), self.where, self.kind, self.size
        return html.table(("start", "end", "where", "kind", "size"), [row])
