"""What an inertial unit measures on the rotating earth: the inverse of the strapdown mechanisation."""

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S
from sensorfault.numerics.gravity import gravity


def felt(
    position: Float[np.ndarray, "T 3"],
    velocity: Float[np.ndarray, "T 3"],
    attitude: Float[np.ndarray, "T 3 3"],
    step_s: float,
) -> tuple[Float[np.ndarray, "T 3"], Float[np.ndarray, "T 3"]]:
    """Angular rate [rad/s] and specific force [m/s²] in body axes, each the mean over the step that ends with the row.

    The first row equals the second. Positions, velocities and attitudes (body to ECEF) are given at the ticks.

    Source: Groves (2013), section 5.3, solved for the measurements.
    """
    omega = np.array([0.0, 0.0, EARTH_RATE_RAD_S])
    c, s = np.cos(EARTH_RATE_RAD_S * step_s), np.sin(EARTH_RATE_RAD_S * step_s)
    earth = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    # exp [α×] = Cᵀ Rz(Ω dt) C⁺, and α to third order of the part that is not symmetric
    turn = attitude[:-1].transpose(0, 2, 1) @ earth @ attitude[1:]
    odd = turn - turn.transpose(0, 2, 1)
    alpha = np.stack([odd[:, 2, 1], odd[:, 0, 2], odd[:, 1, 0]], axis=1) / 2
    alpha = alpha * (1 + (alpha**2).sum(axis=1, keepdims=True) / 6)
    # f = Cᵀ (dv/dt + 2 Ω × v - g), all in the middle of the step
    middle = (attitude[:-1] + attitude[1:]) / 2
    push = np.diff(velocity, axis=0) / step_s + np.cross(omega, velocity[:-1] + velocity[1:])
    push -= gravity((position[:-1] + position[1:]) / 2)
    force = np.einsum("tij,ti->tj", middle, push)
    return np.vstack([alpha[:1], alpha]) / step_s, np.vstack([force[:1], force])
