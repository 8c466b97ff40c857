"""Spreads of windowed means: learned so that each window passes its limit as often as any other."""

import jax.numpy as jnp
import numpy as np

from sensorfault.training.means import fit_spread, mean_tape, windows
from sensorfault.types import Residual

ROWS, C = 20_000, 3


def healthy(seed: int) -> Residual:
    """Noise that lasts: half of it white, half a first-order memory of ten seconds."""
    rng = np.random.default_rng(seed)
    slow = np.zeros((ROWS, C))
    for k in range(1, ROWS):
        slow[k] = 0.9 * slow[k - 1] + np.sqrt(0.19) * rng.standard_normal(C)
    value = (rng.standard_normal((ROWS, C)) + slow) * np.sqrt(2.0)
    valid = rng.random((ROWS, C)) > 0.1
    cov = np.broadcast_to(4.0 * np.eye(C), (ROWS, C, C))
    nil, none = np.zeros((ROWS, C)), np.zeros((ROWS, C), bool)
    rows = np.arange(ROWS, dtype=float), value, cov, nil, nil, nil, valid, none
    return Residual(*map(jnp.asarray, rows), (), jnp.asarray(none))


def test_each_window_passes_a_limit_as_often_as_the_others() -> None:
    plain = windows((1.0, 10.0, 40.0), 1.0, 60.0, C)
    told = healthy(1)
    tape = mean_tape(plain, told)
    assert tape.shape == (ROWS, C, 3)
    np.testing.assert_array_equal(np.isnan(tape), np.repeat(~np.asarray(told.valid)[..., None], 3, axis=2))
    fitted = fit_spread(plain, tape.reshape(-1, 3))
    spread = np.asarray(fitted.spread)
    assert spread[2] > 1.5 * spread[0] / np.sqrt(40.0)  # white noise would be 6.3 times narrower
    over = [np.nanmean(np.abs(mean_tape(fitted, healthy(seed))) > 2.5758, axis=(0, 1)) for seed in range(2, 4)]
    np.testing.assert_allclose(np.mean(over, axis=0), 0.01, rtol=0.4)
