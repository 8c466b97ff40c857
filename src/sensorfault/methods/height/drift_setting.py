"""The setting of a test for slow drift, and its statistic."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.stage import Stage
from sensorfault.numerics.blocks import enough
from sensorfault.stages.statistic.windowed import Measure, Windowed

GAP_BEATS = 10.0  # after this many beats without receiver or barometer a window restarts

Statistic = Stage[Any, Any, Any, Any]


@dataclass(frozen=True)
class Setting:
    """How a test for slow drift is set.

    `window_s`: length of its window. `margin`: limit over the largest healthy score of the training flight.

    `beat_s`: the heights are averaged over this time. `memory_s`: time constant with which the offset of the two
    heights is tracked; inf: the offset of the first ten beats is kept. `lagging`: whether the lag of one height behind
    the other is fitted. `slots` of a window; 0: one for each beat.
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
        """This measure of a window that has one block for each beat."""
        slots = self.slots or enough(self.window_s, self.beat_s)
        return Windowed(measure, jnp.asarray(self.window_s), self.gap_s, channels, slots)


DEFAULT = Setting()


@dataclass(frozen=True)
class DriftTest:
    """A test: its name, its statistic for a number of channels, and its setting."""

    name: str
    statistic: Callable[[Setting, int], Statistic]
    setting: Setting = DEFAULT
