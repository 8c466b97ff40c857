"""Beating wings: their effect on the sensors of the body."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.simulation.noise import gauss_markov

HARMONICS = (1.0, 0.4, 0.15)  # strength of the beat and its first two overtones
HEAVE, SURGE = 3.0, 1.0  # acceleration of the body up and forward at half throttle [m/s^2]
PITCHING = 0.3  # rate of the body's pitch [rad/s]
PULSE_M = 0.4  # height error of a barometer by the pressure of a stroke [m]
FASTER = 0.3  # share by which full throttle raises the beat frequency
UNSTEADY, UNSTEADY_S = 0.02, 2.0  # random variation of the beat frequency, and its correlation time


@dataclass(frozen=True)
class WingBeat:
    """At T ticks: turn rates and accelerations of the body (x forward, y left, z up), and the barometer's error."""

    rate: Float[np.ndarray, "T 3"]  # [rad/s]
    force: Float[np.ndarray, "T 3"]  # [m/s^2]
    height: Float[np.ndarray, " T"]  # [m]


def wing_beat(
    time: Float[np.ndarray, " T"], throttle: Float[np.ndarray, " T"], beat_hz: float, rng: np.random.Generator
) -> WingBeat:
    """Wing beat of `beat_hz` at half throttle; 0: fixed wings.

    The strength follows the throttle. The phases of the overtones differ from sensor to sensor. A sensor that samples
    below twice the frequency of an overtone aliases it, as a real one does.
    """
    if not beat_hz:
        return WingBeat(np.zeros((len(time), 3)), np.zeros((len(time), 3)), np.zeros(len(time)))
    step = float(time[1] - time[0])
    frequency = beat_hz * (1 + FASTER * (throttle - 0.5) + UNSTEADY * gauss_markov(rng, len(time), step, UNSTEADY_S))
    phase = 2 * np.pi * np.cumsum(frequency) * step
    angle = rng.uniform(0, 2 * np.pi, (4, len(HARMONICS)))
    k = np.arange(1, len(HARMONICS) + 1)
    waves = np.sin(k * phase[:, None, None] + angle) @ np.array(HARMONICS)  # [tick, sensor]
    heave, surge, pitching, pulse = (2 * throttle[:, None] * waves).T
    still = np.zeros(len(time))
    return WingBeat(
        rate=np.stack([still, PITCHING * pitching, still], axis=1),
        force=np.stack([SURGE * surge, still, HEAVE * heave], axis=1),
        height=PULSE_M * pulse,
    )
