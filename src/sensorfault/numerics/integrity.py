"""Minimum detectable bias, and the position error that can remain undetected (protection level)."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float


def noncentrality(false_alarms: float, missed: float) -> float:
    """δ = Φ⁻¹(1 - α/2) + Φ⁻¹(1 - β), in standard deviations of a two-sided test on one normal number.

    `false_alarms` α: the share of healthy tests over the limit; `missed` β: that of faulty tests under it. Baarda 1968.
    The opposite tail is neglected, which only matters where β is near 1 - α.
    """
    from scipy.special import ndtri

    return float(-ndtri(false_alarms / 2) - ndtri(missed))


def detectable(
    cov: Float[np.ndarray, "*s C C"], known: Bool[np.ndarray, "*s C"], delta: float
) -> Float[np.ndarray, "*s C"]:
    """Minimum detectable bias of each channel by the w-test, δ / √(S⁻¹)_ii [SI]; inf for unknown channels.

    Baarda 1968. `cov`: covariance S of the innovations; what is not known is marginalised out. `delta`: of
    `noncentrality` at the rates wanted, or the limit in use plus Φ⁻¹(1 - β).
    """
    own = np.diagonal(np.linalg.inv(_alone(cov, known)), axis1=-2, axis2=-1)
    # ∇_i = δ / √(S⁻¹)_ii
    return np.where(known, delta / np.sqrt(own), np.inf)


def detectable_alone(
    cov: Float[np.ndarray, "*s C C"], known: Bool[np.ndarray, "*s C"], delta: float
) -> Float[np.ndarray, "*s C"]:
    """Minimum detectable bias of each channel by a gate on its own innovation, δ √S_ii [SI]; inf if unknown."""
    return np.where(known, delta * np.sqrt(np.diagonal(cov, axis1=-2, axis2=-1)), np.inf)


def inert(detectable: Float[np.ndarray, "*s C"], matters: float) -> Bool[np.ndarray, "*s C"]:
    """Where a gate is inert: S is so large that it misses even a bias of `matters` (the alert limit) [SI].

    Such a gate raises no false alarm either, so a low rate of them is no proof that it works. A channel that is not
    known is inert.
    """
    return detectable > matters


class Protection(NamedTuple):
    """Horizontal protection level [m]: without a fault, and with an undetected one on the `worst` channel."""

    fault_free: float
    faulty: float
    worst: int


def protection(
    gain: Float[np.ndarray, "2 C"],
    horizontal: Float[np.ndarray, "2 2"],
    detectable: Float[np.ndarray, " C"],
    risk: float,
) -> Protection:
    """Bound of the horizontal position error after the update, with at most this risk for each hypothesis.

    Without a fault: √(-2 ln risk), Rayleigh's quantile, times the longer half axis of the error ellipse (RTCA DO-229,
    appendix J: 6.18 at 5e-9). With one on channel i, unnoticed: the shift that its minimum detectable bias makes,
    |K_i| ∇_i, the slope times the bias (DO-229; Diesel & Luu 1995 for filters), and beyond it as much noise.

    `gain`: rows east and north of the Kalman gain K of this epoch [m/m]. So the bias of this epoch alone counts: one
    that lasts goes on to push what is already there, and its level is that of the gain from the bias to the error after
    as many epochs as a test needs. `horizontal`: covariance of the east and north error [m²]. `risk`: of one
    hypothesis; share it out over as many as there are. `detectable`: ∇ [m], of one with β = risk; channels with inf do
    not count: a filter that does not take them in cannot be misled by them.
    """
    # d² = (σ_e² + σ_n²)/2 + √(((σ_e² - σ_n²)/2)² + σ_en²)
    d = float(np.sqrt(np.linalg.eigvalsh(horizontal)[-1]))
    # HPL_0 = √(-2 ln risk) d
    free = float(np.sqrt(-2 * np.log(risk))) * d
    # HPL_1 = max |K_i| ∇_i + HPL_0
    shift = np.hypot(*gain) * np.where(np.isfinite(detectable), detectable, 0.0)
    worst = int(shift.argmax())
    return Protection(free, float(shift[worst]) + free, worst)


def _alone(cov: Float[np.ndarray, "*s C C"], known: Bool[np.ndarray, "*s C"]) -> Float[np.ndarray, "*s C C"]:
    """S of the known channels, with 1 on the diagonal for the others."""
    both = known[..., :, None] & known[..., None, :]
    return np.where(both, cov, np.eye(cov.shape[-1]))
