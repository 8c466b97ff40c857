"""The errors of pseudoranges and clocks against the closed forms of what they are made of."""

import numpy as np
import pytest
from scipy import stats

from sensorfault.simulation import pseudorange, receiver_clock

OVERHEAD = np.full((400, 9), np.pi / 2)


def unit(noise: pseudorange.Noise, runs: int = 60) -> np.ndarray:
    return pseudorange.errors(noise, range(runs), OVERHEAD) / pseudorange.sigma(OVERHEAD)


def test_sigma_by_elevation() -> None:
    assert pseudorange.sigma(np.deg2rad([0.0, 15.0, 90.0])) == pytest.approx(
        [5.4, 1.4 + 4 / np.e, 1.4 + 4 * np.exp(-6)]
    )


def test_gaussian_is_white_and_normal() -> None:
    x = unit("gaussian")
    assert x.std() == pytest.approx(1.0, abs=0.01)
    assert np.mean(x[:, 1:] * x[:, :-1]) == pytest.approx(0.0, abs=0.01)
    assert stats.kurtosis(x.ravel()) == pytest.approx(0.0, abs=0.1)


def test_heavy_has_the_variance_memory_and_tail_of_its_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pseudorange, "BURST_EVERY_S", 1e12)
    x = unit("heavy", 200)
    # 0.6² + 0.7² + 0.35² = 0.97; the squares of t with 4 degrees of freedom have no variance, so the sum settles slowly
    assert x.std() == pytest.approx(np.sqrt(0.36 + 0.49 + 0.1225), abs=0.03)
    for lag in (5, 30, 120):
        taus = np.linspace(8, 40, 1001)
        wanted = 0.1225 + 0.49 * np.mean(np.exp(-lag / taus))
        assert np.mean(x[:, lag:] * x[:, :-lag]) == pytest.approx(wanted, abs=0.03)
    # the difference of neighbours is hardly more than the white part's: where a normal one has 6e-5 beyond four sigmas
    beyond = np.abs(np.diff(x, axis=1)) > 4 * np.diff(x, axis=1).std()
    assert 5e-4 < beyond.mean() < 1e-2


def test_bursts_are_rare_positive_and_as_long_and_high_as_said(monkeypatch: pytest.MonkeyPatch) -> None:
    for part in ("WHITE", "WANDER", "CONSTANT"):
        monkeypatch.setattr(pseudorange, part, 0.0)
    x = unit("heavy", 200)
    inside = x > 1e-9
    assert (x > -1e-9).all()
    begun = inside & ~np.roll(inside, 1, axis=1)
    assert begun.mean() == pytest.approx(1 / 2000, rel=0.15)
    # 1 + floor of an exponential of mean 3: 1 + 1 / (e^(1/3) - 1)
    assert inside.sum() / begun.sum() == pytest.approx(1 + 1 / np.expm1(1 / 3), rel=0.15)
    assert x[begun].mean() == pytest.approx(3.0, rel=0.15)


def test_a_seed_is_itself_in_any_company() -> None:
    alone = pseudorange.errors("heavy", [7], OVERHEAD)[0]
    np.testing.assert_array_equal(pseudorange.errors("heavy", [3, 7], OVERHEAD)[1], alone)
    assert not np.array_equal(alone, pseudorange.errors("heavy", [8], OVERHEAD)[0])


def test_rates_are_worse_low_down() -> None:
    elevation = np.tile(np.deg2rad([0.0, 89.0]), (20_000, 1))
    x = pseudorange.rate_errors([0], elevation)[0]
    assert x.std(axis=0) == pytest.approx([0.1, 0.05], rel=0.03)


def test_a_clock_wanders_as_its_densities_say() -> None:
    time = np.arange(0.0, 101.0)
    paths = np.stack([receiver_clock.wander(np.random.default_rng(seed), time) for seed in range(2000)])
    offset, drift = paths[..., 0], paths[..., 1]
    assert (drift[:, -1] - drift[:, 0]).var() == pytest.approx(0.0355 * 100, rel=0.12)
    # Var(b - b0 - d0 t) = S_b t + S_d t³ / 3
    ahead = offset[:, -1] - offset[:, 0] - 100 * drift[:, 0]
    assert ahead.var() == pytest.approx(0.009 * 100 + 0.0355 * 1e6 / 3, rel=0.12)
    # what a second adds beyond the drift is the white part, with a trapezoid's share of the walk
    white = np.diff(offset, axis=1) - (drift[:, 1:] + drift[:, :-1]) / 2
    assert white.var() == pytest.approx(0.009, rel=0.05)


def test_a_clock_may_jump_by_a_millisecond() -> None:
    time = np.arange(0.0, 10.0)
    steady, jumped = (receiver_clock.wander(np.random.default_rng(1), time, jump) for jump in (None, 4.0))
    np.testing.assert_allclose(jumped[:, 0] - steady[:, 0], np.where(time >= 4, 299792.458, 0.0), atol=1e-6)
    np.testing.assert_array_equal(jumped[:, 1], steady[:, 1])
