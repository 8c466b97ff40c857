"""Detect a slow drift of a height by the slope of its difference to the barometer over two minutes."""

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import recipe
from sensorfault.stages.statistic.slope import Slope

NAME = "slope"


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(Slope(), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = recipe(
    TEST,
    "Slope of receiver minus barometer over 130 s",
    "this project's own study (`sensorfault reproduce multistep`), for the faults of Wang S. et al.",
)
