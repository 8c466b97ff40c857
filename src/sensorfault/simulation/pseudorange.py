"""Errors of pseudoranges and range rates: noise by elevation, and reflections."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from jaxtyping import Float

Noise = Literal["gaussian", "heavy"]

WHITE, WANDER, CONSTANT = 0.6, 0.7, 0.35  # parts of heavy noise, in sigmas
WHITE_DOF, WANDER_DOF = 4, 5
WANDER_S = (8.0, 40.0)  # correlation time, one per satellite
BURST_EVERY_S, BURST_S, BURST_SIGMAS = 2000.0, 3.0, 3.0  # means of exponential distributions
RATE_M_S = (0.05, 0.1)  # of range rates: overhead and on the horizon


def sigma(elevation: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """Standard deviation of a pseudorange [m] by elevation [rad]: 1.5 m overhead, 3.5 m at ten degrees."""
    # σ = 1.4 + 4 exp(-el / 15°)
    return np.asarray(1.4 + 4.0 * np.exp(-np.asarray(elevation) / np.deg2rad(15.0)))


def errors(
    noise: Noise, seeds: Sequence[int], elevation: Float[np.ndarray, "T S"], period_s: float = 1.0
) -> Float[np.ndarray, "N T S"]:
    """Errors of pseudoranges [m] for each seed; the errors of one seed do not depend on the other seeds.

    *gaussian*: sigma times white noise. *heavy*: sigma times the sum of white noise (0.6 of Student's t with 4 degrees
    of freedom), wander (0.7 of a first-order Gauss-Markov process of 8 to 40 s driven by t with 5), a constant (0.35 of
    a standard normal) and bursts like reflections: always too long, one in 2000 s per satellite, on average 3 s long
    and 3 sigmas high. Both t are scaled to variance 1, so that the sum has the given sigma; its tail and its
    correlation are heavier. The paper does not describe its noise. With this one, a limit on each innovation finds
    steps as often as in the paper.

    Args:
        noise: gaussian or heavy.
        seeds: N of them.
        elevation: of S satellites at T epochs [rad].
        period_s: from one epoch to the next [s].
    """
    draw = _gaussian if noise == "gaussian" else _heavy
    unit = np.stack([draw(np.random.default_rng([seed, 1]), elevation.shape, period_s) for seed in seeds])
    return np.asarray(sigma(elevation) * unit)


def rate_errors(seeds: Sequence[int], elevation: Float[np.ndarray, "T S"]) -> Float[np.ndarray, "N T S"]:
    """Errors of range rates [m/s] for each seed: white, 0.05 m/s overhead to 0.1 m/s on the horizon."""
    high, low = RATE_M_S
    scale = high + (low - high) * np.exp(-elevation / np.deg2rad(15.0))
    unit = np.stack([np.random.default_rng([seed, 2]).standard_normal(elevation.shape) for seed in seeds])
    return np.asarray(scale * unit)


def _gaussian(rng: np.random.Generator, shape: tuple[int, ...], period_s: float) -> Float[np.ndarray, "T S"]:
    return rng.standard_normal(shape)


def _heavy(rng: np.random.Generator, shape: tuple[int, ...], period_s: float) -> Float[np.ndarray, "T S"]:
    satellites = shape[1]
    white = WHITE * _student(rng, WHITE_DOF, shape)
    constant = CONSTANT * rng.standard_normal(satellites)
    a = np.exp(-period_s / rng.uniform(*WANDER_S, satellites))
    # x⁺ = a x + √(1 - a²) w keeps the variance of w
    wander = _student(rng, WANDER_DOF, shape)
    wander[1:] *= np.sqrt(1 - a**2)
    for t in range(1, len(wander)):
        wander[t] += a * wander[t - 1]
    return np.asarray(white + WANDER * wander + constant + _bursts(rng, shape, period_s))


def _student(rng: np.random.Generator, degrees: int, shape: tuple[int, ...]) -> Float[np.ndarray, "T S"]:
    """Student's t with variance 1: that of t itself is n / (n - 2)."""
    return np.asarray(rng.standard_t(degrees, shape) * np.sqrt((degrees - 2) / degrees))


def _bursts(rng: np.random.Generator, shape: tuple[int, ...], period_s: float) -> Float[np.ndarray, "T S"]:
    begin, satellite = np.nonzero(rng.random(shape) < period_s / BURST_EVERY_S)
    length = 1 + np.floor(rng.exponential(BURST_S, len(begin)) / period_s).astype(int)
    size = BURST_SIGMAS * rng.exponential(1.0, len(begin))
    step = np.zeros((shape[0] + 1, shape[1]))
    np.add.at(step, (begin, satellite), size)
    np.add.at(step, (np.minimum(begin + length, shape[0]), satellite), -size)
    return np.asarray(np.cumsum(step, axis=0)[:-1])
