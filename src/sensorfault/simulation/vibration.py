"""How the road and the engine shake the six axes of an inertial sensor."""

import numpy as np
from jaxtyping import Float

from sensorfault.simulation.noise import band, gauss_markov

# Centre [Hz] and width of each band: body on its springs, wheel hop, tyres and engine.
BANDS = ((1.6, 0.5), (9.0, 0.5), (18.0, 0.3))

# Standard deviation at 10 m/s by band, and which part of the axis' shaking comes from a source it shares with others:
# bumps under both wheels shake x, z and pitch, bumps under one shake y, roll and yaw. Levels and shares are near those
# of the drive through Dresden by P. Balzer (github.com/balzer82/Kalman, 2014-03-26), whose sensor box shook a lot.
LEVEL = np.array(
    [
        [0.028, 0.021, 0.010],  # gyro x, roll [rad/s]
        [0.042, 0.035, 0.052],  # gyro y, pitch
        [0.005, 0.006, 0.005],  # gyro z, yaw
        [0.50, 0.70, 0.90],  # accelerometer x [m/s^2]
        [0.30, 0.35, 0.42],  # accelerometer y
        [0.50, 0.60, 0.90],  # accelerometer z
    ]
)
BOTH_WHEELS = np.array([0.0, 0.7, 0.0, 0.65, 0.0, 0.75])
ONE_WHEEL = np.array([0.7, 0.0, 0.6, 0.0, -0.35, 0.0])
IDLE = 0.2  # share of the highest band at standstill, from the engine
PATCH_SD, PATCH_S = 0.35, 2.0  # the road's roughness changes from patch to patch: log standard deviation, seconds


def vibration(speed: Float[np.ndarray, " T"], rate_hz: float, rng: np.random.Generator) -> Float[np.ndarray, "T 6"]:
    """Vibration of gyro x, y, z [rad/s] and accelerometer x, y, z [m/s^2], which grows with `speed` [m/s]."""
    n = len(speed)
    driven = np.exp(PATCH_SD * gauss_markov(rng, n, 1 / rate_hz, PATCH_S)) * speed / 10.0
    own = np.sqrt(1 - BOTH_WHEELS**2 - ONE_WHEEL**2)
    shaking = np.zeros((n, 6))
    for level, shape, idle in zip(LEVEL.T, BANDS, (0.0, 0.0, IDLE), strict=True):
        both, one, *each = (band(rng, n, rate_hz, *shape) for _ in range(8))
        mixed = np.outer(both, BOTH_WHEELS) + np.outer(one, ONE_WHEEL) + np.stack(each, axis=1) * own
        shaking += np.hypot(driven, idle)[:, None] * mixed * level
    return shaking
