"""An inertial sensor in a car: true rates and forces, and a consumer-grade sensor. Axes: x forward, y left, z up."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.simulation.motion import GRAVITY, Motion
from sensorfault.simulation.noise import gauss_markov

DEGREE = np.pi / 180


@dataclass(frozen=True)
class Grade:
    """Errors of three axes of one kind, in u = rad/s or m/s^2.

    The defaults below are of consumer MEMS grade, as data sheets of six-axis phone sensors state them (Bosch BMI160:
    0.007 °/s/√Hz, 180 µg/√Hz, ±3 °/s and ±40 mg at most when switched on); the bias instability within a run is a
    Gauss-Markov process.
    """

    noise_density: float  # [u/√Hz]
    turn_on_bias: float  # standard deviation from one drive to the next [u]
    bias_instability: float  # standard deviation in a drive [u]
    bias_time_s: float  # its correlation time [s]
    resolution: float  # one count [u]
    range: float  # largest value [u]


CONSUMER_GYRO = Grade(0.007 * DEGREE, 0.5 * DEGREE, 0.02 * DEGREE, 200.0, DEGREE / 131.072, 250 * DEGREE)
CONSUMER_ACCELEROMETER = Grade(180e-6 * GRAVITY, 15e-3 * GRAVITY, 0.5e-3 * GRAVITY, 200.0, GRAVITY / 8192, 4 * GRAVITY)


def angular_rate(m: Motion) -> Float[np.ndarray, "T 3"]:
    """True body rates [rad/s] from Euler rates, order yaw, pitch, roll (Groves 2013, 2.58)."""
    dt = float(m.time[1] - m.time[0])
    d_roll, d_pitch, d_yaw = (np.gradient(angle, dt) for angle in (m.roll, m.pitch, m.heading))
    # ωx = φ' - ψ' sin θ,  ωy = θ' cos φ + ψ' cos θ sin φ,  ωz = -θ' sin φ + ψ' cos θ cos φ
    across = d_yaw * np.cos(m.pitch)
    return np.stack(
        (
            d_roll - d_yaw * np.sin(m.pitch),
            d_pitch * np.cos(m.roll) + across * np.sin(m.roll),
            -d_pitch * np.sin(m.roll) + across * np.cos(m.roll),
        ),
        axis=1,
    )


def specific_force(m: Motion) -> Float[np.ndarray, "T 3"]:
    """True specific force [m/s^2]: acceleration minus gravity, in body axes; at rest on the level (0, 0, 9.81)."""
    forward, left, up = m.acceleration.T
    sin_p, cos_p, sin_r, cos_r = np.sin(m.pitch), np.cos(m.pitch), np.sin(m.roll), np.cos(m.roll)
    up = up + GRAVITY
    # f = Rx(φ)ᵀ Ry(θ)ᵀ (a + g)
    x = cos_p * forward - sin_p * up
    down_nose = sin_p * forward + cos_p * up
    return np.stack((x, cos_r * left + sin_r * down_nose, -sin_r * left + cos_r * down_nose), axis=1)


def measure(
    true: Float[np.ndarray, "T 3"], rate_hz: float, grade: Grade, rng: np.random.Generator
) -> Float[np.ndarray, "T 3"]:
    """Add bias, noise, quantisation and saturation to three axes."""
    n = len(true)
    wander = np.stack([gauss_markov(rng, n, 1 / rate_hz, grade.bias_time_s) for _ in range(3)], axis=1)
    bias = grade.turn_on_bias * rng.standard_normal(3) + grade.bias_instability * wander
    # A density N sampled at f has the standard deviation N √f.
    white = grade.noise_density * np.sqrt(rate_hz) * rng.standard_normal((n, 3))
    counts = np.round((true + bias + white) / grade.resolution)
    return np.asarray(np.clip(counts * grade.resolution, -grade.range, grade.range))
