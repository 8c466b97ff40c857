"""Extremes that one contaminated row does not ruin, and that health keeps."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import laplace, norm, t

import fitted
from sensorfault.calibration.extremes import explained, explained_max, tail_limit
from sensorfault.logs import read
from sensorfault.methods.catalog import recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session


@pytest.mark.parametrize("shape", [norm, laplace, t(4)], ids=["normal", "exponential", "heavy"])
@pytest.mark.parametrize("length", [1000, 20000])
def test_health_stays_below(shape, length: int) -> None:
    """In at most a few of two hundred logs does any of their values lie beyond."""
    random = np.random.default_rng(0)
    drawn = np.abs(shape.rvs(size=(200, length), random_state=random))
    beyond = sum(one.max() > tail_limit(one) for one in drawn)
    assert beyond <= 10


def test_a_power_law_is_drawn_out_as_it_is() -> None:
    """Of sizes p^-1/4 for p = 1/N .. 1, one in a hundred logs of N exceeds (N / 0.01)^1/4."""
    n = 100_000
    size = (np.arange(1, n + 1) / n) ** -0.25
    assert tail_limit(size) == pytest.approx((n / 0.01) ** 0.25, rel=0.01)
    assert tail_limit(size, tests=6) == pytest.approx((6 * n / 0.01) ** 0.25, rel=0.01)


@pytest.mark.parametrize("rows", [1, 5])
def test_what_is_far_out_has_no_say(rows: int) -> None:
    size = np.abs(np.random.default_rng(1).standard_normal(3000))
    spoilt = size.copy()
    spoilt[:rows] = 1e3
    assert explained_max(spoilt) == size[rows:].max()
    near = explained(np.column_stack([spoilt, size]))
    assert not near[:rows, 0].any()
    assert near[rows:].all()
    assert near[:, 1].all()


def test_a_channel_that_mostly_rests_is_all_explained() -> None:
    assert explained(np.append(np.zeros(500), 3.0)[:, None]).all()


def built(name: str, spoil: float) -> Model:
    """Straight from the recipe, which has no one to leave out suspects for it."""
    log = fitted.rig().between(end_s=60.0)
    value = log.value.copy()
    value[1000, 3] += spoil * value[:, 3].std()
    return recipe(name).build(replace(log, value=value), 0, Session())


def test_one_contaminated_row_ruins_the_limit_as_published_and_not_the_robust_one() -> None:
    """Neither limit nor scaling nor the weights that follow from them move by more than a row's absence explains."""

    def numbers(model: Model) -> list[np.ndarray]:
        residual, threshold = model.monitor.residual, model.monitor.branches[0].threshold
        return [threshold.largest, residual.half, residual.center, residual.output @ residual.weights]

    for clean, spoilt in zip(numbers(built("elm-robust", 0)), numbers(built("elm-robust", 300)), strict=True):
        np.testing.assert_allclose(spoilt, clean, rtol=0.02, atol=0.02)
    assert numbers(built("elm-autoencoder", 300))[1][3] > 50 * numbers(built("elm-autoencoder", 0))[1][3]


@pytest.mark.real
@pytest.mark.parametrize("name", ["dresden_50hz", "gnss_imu_drive0708"])
def test_a_healthy_drive_keeps_its_extremes(name: str, real_data: Path) -> None:
    log = read(real_data / "road" / name).select([f"{s}.{a}" for s in ("gyro", "accelerometer") for a in "xyz"])
    assert explained(log.between(end_s=float(log.time[0]) + 0.6 * log.duration_s).value).all()
