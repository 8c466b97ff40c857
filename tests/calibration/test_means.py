"""Spreads of windowed means: learned so that each window passes its limit as often as any other."""

import numpy as np

from sensorfault.calibration.means import fit_spread, mean_tape, windows

ROWS, C = 20_000, 3


def healthy(seed: int) -> np.ndarray:
    """Noise that lasts: half of it white, half a first-order memory of ten seconds; one in ten is missing."""
    rng = np.random.default_rng(seed)
    slow = np.zeros((ROWS, C))
    for k in range(1, ROWS):
        slow[k] = 0.9 * slow[k - 1] + np.sqrt(0.19) * rng.standard_normal(C)
    value = (rng.standard_normal((ROWS, C)) + slow) / np.sqrt(2.0)
    return np.where(rng.random((ROWS, C)) > 0.1, value, np.nan)


def test_each_window_passes_a_limit_as_often_as_the_others() -> None:
    plain = windows((1.0, 10.0, 40.0), 1.0, 60.0, C)
    result = healthy(1)
    tape = mean_tape(plain, result, 1.0)
    assert tape.shape == (ROWS, C, 3)
    np.testing.assert_array_equal(np.isnan(tape), np.repeat(np.isnan(result)[..., None], 3, axis=2))
    np.testing.assert_allclose(tape[500, :, 1], np.nanmean(result[491:501], axis=0) + 0 * result[500])
    fitted = fit_spread(plain, tape.reshape(-1, 3))
    spread = np.asarray(fitted.spread)
    assert spread[2] > 1.5 * spread[0] / np.sqrt(40.0)  # white noise would be 6.3 times narrower
    over = [np.nanmean(np.abs(mean_tape(fitted, healthy(seed), 1.0)) > 2.5758, axis=(0, 1)) for seed in range(2, 4)]
    np.testing.assert_allclose(np.mean(over, axis=0), 0.01, rtol=0.4)
