"""Detect a slow drift of a height by the slope of its difference to the barometer over two minutes."""

from functools import partial

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import build
from sensorfault.methods.height.needs import two_heights
from sensorfault.methods.recipe import Recipe
from sensorfault.stages.statistic.slope import Slope

NAME = "slope"


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(Slope(), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = Recipe(
    name=NAME,
    title="Slope of receiver minus barometer over 130 s; assumes a healthy barometer",
    source="this project's own study (`sensorfault reproduce multistep`), for the faults of Wang S. et al.",
    false_alarm_rate="not designed: the limit is 10 % above the largest score of the training flight",
    build=partial(build, TEST),
    needs=two_heights,
)
