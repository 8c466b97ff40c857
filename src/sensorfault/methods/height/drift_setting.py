"""How a test for a slow drift is set, and its statistic."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.stage import Stage
from sensorfault.numerics.blocks import enough
from sensorfault.stages.statistic.windowed import Measure, Windowed

GAP_BEATS = 10.0  # without the receiver or the barometer for so long, a window begins anew

Statistic = Stage[Any, Any, Any, Any]


@dataclass(frozen=True)
class Setting:
    """`window_s`: how long a test looks back. `margin`: on the largest healthy score of the training flight.

    `memory_s`: how slowly the offset of the two heights is followed; inf: it is that of the first ten beats for good.
    `lagging`: whether the lag of one height behind the other is learned. `slots` of a window; 0: one for each beat.
    """

    window_s: float = 130.0
    beat_s: float = 1.0
    margin: float = 1.1
    memory_s: float = np.inf
    lagging: bool = True
    slots: int = 0

    @property
    def gap_s(self) -> Float[Array, ""]:
        """A longer silence empties a window [s]."""
        return jnp.asarray(GAP_BEATS * self.beat_s)

    def windowed(self, measure: Measure, channels: int) -> Windowed:
        """This measure of a window with a block for each beat."""
        slots = self.slots or enough(self.window_s, self.beat_s)
        return Windowed(measure, jnp.asarray(self.window_s), self.gap_s, channels, slots)


DEFAULT = Setting()


@dataclass(frozen=True)
class DriftTest:
    """A test by name: its statistic of so many channels, and how it is set."""

    name: str
    statistic: Callable[[Setting, int], Statistic]
    setting: Setting = DEFAULT
