"""Leaders that sail beside a follower and tell it by sound where they are: how far away they seem to be, and when."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

Noise = Callable[[np.random.Generator, int], Float[np.ndarray, " n"]]  # so many errors of a range [m]
LEADER_SD = 0.3  # error of where a leader says it is, north and east [m]


@dataclass(frozen=True)
class Ranging:
    """`period_s`: between two ranges of one leader. `lost`: share of them that never arrive. `alternating`: leaders
    take turns, else each has a clock of its own. `sound`: true over assumed speed of sound. `noise`: errors of the
    ranges, Gaussian of `sigma_m` if not given; a share `outliers` of them is up to `outlier_m` too long (an echo).
    """

    leaders: int = 2
    period_s: float = 4.7
    lost: float = 0.05
    alternating: bool = True
    sigma_m: float = 3.0
    sound: float = 1.0
    outliers: float = 0.0
    outlier_m: float = 60.0
    noise: Noise | None = None


@dataclass(frozen=True)
class Heard:
    """Of each of L leaders: where it is and says it is, north, east, down [m]; and the range to it [m]."""

    position: Float[np.ndarray, "T L 3"]
    result: Float[np.ndarray, "T L 3"]
    true: Float[np.ndarray, "T L"]
    range: Float[np.ndarray, "T L"]
    received: Bool[np.ndarray, "T L"]


def hear(
    time: Float[np.ndarray, " T"], follower: Float[np.ndarray, "T 3"], way: Ranging, rng: np.random.Generator
) -> Heard:
    """What a follower on this path (north, east, down [m]) hears of leaders that keep around it."""
    on_path, on_time, on_error = rng.spawn(3)
    position = np.stack([_beside(time, follower, j, way.leaders, on_path) for j in range(way.leaders)], axis=1)
    true = np.linalg.norm(position - follower[:, None], axis=2)
    received = _schedule(time, way, on_time)
    draw = way.noise or (lambda rng, n: way.sigma_m * rng.standard_normal(n))
    error = draw(on_error, true.size).reshape(true.shape)
    echo = on_error.random(true.shape) < way.outliers
    error = error + echo * way.outlier_m * on_error.random(true.shape)
    result = position.copy()
    result[:, :, :2] += LEADER_SD * on_error.standard_normal(result[:, :, :2].shape)
    return Heard(position, result, true, true / way.sound + error, received)


def _beside(
    time: Float[np.ndarray, " T"], follower: Float[np.ndarray, "T 3"], j: int, leaders: int, rng: np.random.Generator
) -> Float[np.ndarray, "T 3"]:
    """A leader off to a side of its own, that swings to and fro by some 1 m/s."""
    side = 2 * np.pi * (j + rng.uniform(-0.2, 0.2)) / (2 * leaders)
    off = rng.uniform(250, 500) * np.array([np.cos(side), np.sin(side)])
    swing = np.zeros((len(time), 2))
    for period in rng.uniform(300, 1200, 2):
        phase = rng.uniform(0, 2 * np.pi, 2)
        speed = rng.uniform(0.7, 1.2)
        swing += speed * period / (2 * np.pi) * np.sin(2 * np.pi * time[:, None] / period + phase)
    return np.column_stack([follower[:, :2] + off + swing, np.full(len(time), rng.uniform(2, 10))])


def _schedule(time: Float[np.ndarray, " T"], way: Ranging, rng: np.random.Generator) -> Bool[np.ndarray, "T L"]:
    """At which ticks a range to which leader arrives."""
    received = np.zeros((len(time), way.leaders), bool)
    for j in range(way.leaders):
        first = j * way.period_s / way.leaders if way.alternating else rng.uniform(0, way.period_s)
        times = np.arange(time[0] + first + 1e-3, time[-1], way.period_s)
        times = times + rng.uniform(-0.2, 0.2, len(times)) * way.period_s / way.leaders
        at = np.searchsorted(time, times[rng.random(len(times)) >= way.lost])
        received[np.clip(at, 0, len(time) - 1), j] = True
    return received
