"""Detect a slow drift of a height: the newest part of its difference to the barometer against the oldest part."""

import jax.numpy as jnp

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import recipe
from sensorfault.stages.statistic.mean_pair import MeanPair

NAME = "mean-pair"
SHARE = 1 / 3  # of the window, newest and oldest


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(MeanPair(jnp.asarray(SHARE)), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = recipe(
    TEST,
    "Receiver minus barometer: the newest third of 130 s against the oldest",
    "this project's own study (`sensorfault reproduce multistep`), for the faults of Wang S. et al.",
)
