"""What the tracker of events must know of a model."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.runtime.model import MOTION

Accused = int | str | None  # a channel, MOTION, or nobody: the fault is known, the channel is not


@dataclass(frozen=True)
class EventContext:
    """The channels of a model, and whom each of its tests may accuse.

    `tests[k]`: the columns that test k accuses, one or all of them together; None for a test that finds out whom,
    MOTION for one of the vehicle. `tick_s`: the clock; where it stands still for longer than three ticks there is a
    hole in the log, which is no sensor's silence.
    """

    method: str
    sensor: tuple[str, ...]
    channel: tuple[str, ...]
    period_s: Float[np.ndarray, " C"]
    silent_after_s: Float[np.ndarray, " C"]
    sigma: Float[np.ndarray, " C"]  # of the healthy residual [SI]
    tests: tuple[tuple[int, ...] | str | None, ...]
    tick_s: float

    @property
    def hole_s(self) -> float:
        """A longer time between two samples is a hole [s]."""
        return 3.5 * self.tick_s

    @property
    def columns(self) -> dict[str, list[int]]:
        """The channels of each sensor."""
        names = dict.fromkeys(self.sensor)
        return {name: [c for c, owner in enumerate(self.sensor) if owner == name] for name in names}

    def may_accuse(self, accused: Accused) -> list[bool]:
        """For each test, whether its alarm may be why this one is accused.

        Where nobody is named, any test of the sensors may be why: its alarm is all that is known.
        """
        return [_may_accuse(test, accused) for test in self.tests]


def _may_accuse(test: tuple[int, ...] | str | None, accused: Accused) -> bool:
    if accused == MOTION or test == MOTION:
        return accused == test
    return accused is None or test is None or accused in test
