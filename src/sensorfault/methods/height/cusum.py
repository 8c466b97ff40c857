"""Detect a slow drift of a height by the cumulative sum of its difference to the barometer."""

from functools import partial

import jax.numpy as jnp

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import build
from sensorfault.methods.height.needs import two_heights
from sensorfault.methods.recipe import Recipe
from sensorfault.stages.statistic.cusum import Cusum

NAME = "cusum"
ALLOWANCE = 0.5  # set for an offset of one standard deviation


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return Cusum(jnp.full(channels, ALLOWANCE), jnp.full(channels, jnp.inf), setting.gap_s)


TEST = DriftTest(NAME, statistic, Setting(memory_s=120.0))
RECIPE = Recipe(
    name=NAME,
    title="Cumulative sum of receiver minus barometer; their offset is tracked over two minutes; "
    "assumes a healthy barometer",
    source="Page 1954; for the faults of Wang S. et al.",
    false_alarm_rate="not designed: the limit is 10 % above the largest score of the training flight",
    build=partial(build, TEST),
    needs=two_heights,
)
