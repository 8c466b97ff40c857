import numpy as np
import pytest

from sensorfault.simulation.noise import band, gauss_markov, smooth


def test_gauss_markov_forgets_exponentially() -> None:
    x = gauss_markov(np.random.default_rng(0), 400_000, 0.1, 2.0)
    assert x.std() == pytest.approx(1.0, rel=0.05)
    for lag in (5, 20, 60):
        assert np.mean(x[lag:] * x[:-lag]) == pytest.approx(np.exp(-lag * 0.1 / 2.0), abs=0.05)


def test_the_end_does_not_know_the_beginning() -> None:
    ends = np.array([gauss_markov(np.random.default_rng(i), 51, 0.1, 10.0)[[0, -1]] for i in range(3000)])
    # 5 s apart: e^-0.5; a ring would close over its padding of five time constants, e^-5.
    assert np.corrcoef(ends.T)[0, 1] == pytest.approx(np.exp(-0.5), abs=0.05)
    assert ends.std() == pytest.approx(1.0, rel=0.05)


def test_a_band_has_its_power_around_its_centre() -> None:
    x = band(np.random.default_rng(0), 100_000, 50.0, 9.0, 0.3)
    assert x.std() == pytest.approx(1.0, rel=0.02)
    power = np.abs(np.fft.rfft(x)) ** 2
    f = np.fft.rfftfreq(len(x), 1 / 50.0)
    # Within one width of the centre lies 1.5 to 2/3 of a bell over log f, weighted by f: about two thirds.
    inside = power[(f > 9.0 * np.exp(-0.3)) & (f < 9.0 * np.exp(0.3))].sum() / power.sum()
    assert 0.6 < inside < 0.75
    assert power[f < 1.0].sum() < 1e-3 * power.sum()


def test_smoothing_keeps_the_mean_and_the_ends() -> None:
    step = np.repeat([0.0, 1.0], 50)
    soft = smooth(step, 20)
    assert len(soft) == 100
    assert soft.mean() == pytest.approx(step.mean())
    assert (np.diff(soft) >= 0).all()
    assert 0.05 < np.diff(soft).max() < 0.15
    np.testing.assert_allclose(soft[[0, -1]], [0.0, 1.0], atol=1e-15)
