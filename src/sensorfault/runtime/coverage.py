"""What the default method could compare, and what it could not and why."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Coverage:
    """Which sensors were compared with which others, and which were not and why.

    `alone`: those of the latter that were still checked for spikes, exact repeats, silence and impossible values.

    `sentences`: what else to know of the answer: where the limits come from, what is usual for this vehicle.
    """

    compared: dict[str, tuple[str, ...]]
    not_compared: dict[str, str]
    alone: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()
