"""The clock of a satellite receiver: a crystal oscillator whose offset and rate wander."""

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.gnss.constants import LIGHT_M_S

OFFSET_M, DRIFT_M_S = 1e4, 30.0  # standard deviation at the start; a TCXO is good to some parts in ten million
# White noise of the frequency [m²/s], and its random walk [(m/s)²/s], of a TCXO
OFFSET_DENSITY, DRIFT_DENSITY = 0.009, 0.0355
JUMP_M = 1e-3 * LIGHT_M_S


def wander(
    rng: np.random.Generator, time: Float[np.ndarray, " T"], jump_s: float | None = None
) -> Float[np.ndarray, "T 2"]:
    """Offset [m] and drift [m/s] of a temperature-compensated oscillator at these times.

    Args:
        rng: random numbers.
        time: rising [s].
        jump_s: from this time on the offset is a millisecond larger, like the clock jumps of cheap receivers.

    Source: R. G. Brown, P. Y. C. Hwang, Introduction to Random Signals and Applied Kalman Filtering, 4th ed. (2012),
    section 9.3, with the Allan coefficients h0 = 2e-19 and h-2 = 2e-20 of its table 9.3: c² h0 / 2 and 2 π² c² h-2.
    """
    step = np.diff(time)
    walk, turn = rng.standard_normal((2, len(step)))
    start_m, start_m_s = np.array([OFFSET_M, DRIFT_M_S]) * rng.standard_normal(2)
    drift = start_m_s + np.concatenate([[0.0], np.cumsum(np.sqrt(DRIFT_DENSITY * step) * turn)])
    # b⁺ = b + (d + d⁺) / 2 τ + w
    change = (drift[1:] + drift[:-1]) / 2 * step + np.sqrt(OFFSET_DENSITY * step) * walk
    offset = start_m + np.concatenate([[0.0], np.cumsum(change)])
    if jump_s is not None:
        offset = offset + JUMP_M * (time >= jump_s)
    return np.stack([offset, drift], axis=1)
