"""Detect a slow drift of a height by the likelihood ratio of a ramp in its difference to the barometer."""

from functools import partial

from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.drifting import build
from sensorfault.methods.height.needs import two_heights
from sensorfault.methods.recipe import Recipe
from sensorfault.stages.statistic.ramp_glr import RampGlr

NAME = "ramp-glr"


def statistic(setting: Setting, channels: int) -> Statistic:
    """The test of every channel."""
    return setting.windowed(RampGlr(), channels)


TEST = DriftTest(NAME, statistic)
RECIPE = Recipe(
    name=NAME,
    title="Largest likelihood ratio of a ramp in receiver minus barometer, over all onsets in 130 s; "
    "assumes a healthy barometer",
    source="Willsky & Jones 1976; for the faults of Wang S. et al.",
    false_alarm_rate="not designed: the limit is 10 % above the largest score of the training flight",
    build=partial(build, TEST),
    needs=two_heights,
)
