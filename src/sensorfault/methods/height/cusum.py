"""Detect a slow drift of a height by the cumulative sum of its difference to the barometer."""

import jax.numpy as jnp

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import recipe
from sensorfault.stages.statistic.cusum import Cusum

NAME = "cusum"
ALLOWANCE = 0.5  # set for an offset of one standard deviation


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return Cusum(jnp.full(channels, ALLOWANCE), jnp.full(channels, jnp.inf), setting.gap_s)


TEST = DriftTest(NAME, statistic, Setting(memory_s=120.0))
RECIPE = recipe(
    TEST,
    "Cumulative sum of receiver minus barometer; their offset is tracked over two minutes",
    "Page 1954; for the faults of Wang S. et al.",
)
