"""The compared tests for a slow drift: recipes, and statistics without a recipe."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp

from sensorfault.methods.height import cusum, mean_pair, ramp_glr, slope
from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.stages.statistic.averaged_innovation import AveragedInnovation
from sensorfault.stages.statistic.ewma import Ewma
from sensorfault.stages.statistic.windowed_chi_square import WindowedChiSquare

MEMORY_S = 120.0  # time constant of the offset, for tests that need a difference around zero [s]
_FOLLOWING = Setting(memory_s=MEMORY_S, window_s=60.0)


def _ewma(setting: Setting, channels: int) -> Statistic:
    return Ewma(jnp.full(channels, setting.window_s / 4), setting.gap_s)


def _averaged(setting: Setting, channels: int) -> Statistic:
    return setting.windowed(AveragedInnovation(), channels)


def _chi_square(setting: Setting, channels: int) -> Statistic:
    return setting.windowed(WindowedChiSquare(), channels)


TESTS = {
    test.name: test
    for test in (
        slope.TEST,
        mean_pair.TEST,
        ramp_glr.TEST,
        cusum.TEST,
        DriftTest("ewma", _ewma, _FOLLOWING),
        DriftTest("averaged-innovation", _averaged, _FOLLOWING),
        DriftTest("windowed-chi-square", _chi_square, _FOLLOWING),
    )
}
SWEPT = (slope.NAME, ramp_glr.NAME)  # tests with a sweep of windows; also run without the lag
