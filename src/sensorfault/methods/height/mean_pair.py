"""Detect a slow drift of a height: the newest part of its difference to the barometer against the oldest part."""

from functools import partial

import jax.numpy as jnp

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import build
from sensorfault.methods.height.needs import two_heights
from sensorfault.methods.recipe import Recipe
from sensorfault.stages.statistic.mean_pair import MeanPair

NAME = "mean-pair"
SHARE = 1 / 3  # of the window, newest and oldest


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(MeanPair(jnp.asarray(SHARE)), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = Recipe(
    name=NAME,
    title="Receiver minus barometer: the newest third of 130 s against the oldest; assumes a healthy barometer",
    source="this project's own study (`sensorfault reproduce multistep`), for the faults of Wang S. et al.",
    false_alarm_rate="not designed: the limit is 10 % above the largest score of the training flight",
    build=partial(build, TEST),
    needs=two_heights,
)
