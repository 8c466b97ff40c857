"""Detect a slow drift of a height by the likelihood ratio of a ramp in its difference to the barometer."""

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import recipe
from sensorfault.stages.statistic.ramp_glr import RampGlr

NAME = "ramp-glr"


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(RampGlr(), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = recipe(
    TEST,
    "Largest likelihood ratio of a ramp in receiver minus barometer, over all onsets in 130 s",
    "Willsky & Jones 1976; for the faults of Wang S. et al.",
)
