"""Leaders that accompany a follower under water and send their positions by sound: ranges and their times."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

Noise = Callable[[np.random.Generator, int], Float[np.ndarray, " n"]]  # standard deviation of a range [m]
LEADER_SD = 0.3  # error of a leader's reported position, north and east [m]


@dataclass(frozen=True)
class Ranging:
    """`period_s`: time between two ranges of one leader. `lost`: share of ranges that never arrive. `alternating`:
    leaders take turns, else each has its own clock. `sound`: true over assumed speed of sound. `noise`: errors of the
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
    """For each of L leaders: its true and its reported position, north, east, down [m], and the range to it [m]."""

    position: Float[np.ndarray, "T L 3"]
    result: Float[np.ndarray, "T L 3"]
    true: Float[np.ndarray, "T L"]
    range: Float[np.ndarray, "T L"]
    received: Bool[np.ndarray, "T L"]


def hear(
    time: Float[np.ndarray, " T"], follower: Float[np.ndarray, "T 3"], way: Ranging, rng: np.random.Generator
) -> Heard:
    """What a follower on this path (north, east, down [m]) receives from leaders that stay near it."""
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
    """A leader to one side of the follower, moving to and fro with about 1 m/s."""
    side = 2 * np.pi * (j + rng.uniform(-0.2, 0.2)) / (2 * leaders)
    off = rng.uniform(250, 500) * np.array([np.cos(side), np.sin(side)])
    swing = np.zeros((len(time), 2))
    for period in rng.uniform(300, 1200, 2):
        phase = rng.uniform(0, 2 * np.pi, 2)
        speed = rng.uniform(0.7, 1.2)
        swing += speed * period / (2 * np.pi) * np.sin(2 * np.pi * time[:, None] / period + phase)
    return np.column_stack([follower[:, :2] + off + swing, np.full(len(time), rng.uniform(2, 10))])


def _schedule(time: Float[np.ndarray, " T"], way: Ranging, rng: np.random.Generator) -> Bool[np.ndarray, "T L"]:
    """At which ticks a range to each leader arrives."""
    received = np.zeros((len(time), way.leaders), bool)
    for j in range(way.leaders):
        first = j * way.period_s / way.leaders if way.alternating else rng.uniform(0, way.period_s)
        times = np.arange(time[0] + first + 1e-3, time[-1], way.period_s)
        times = times + rng.uniform(-0.2, 0.2, len(times)) * way.period_s / way.leaders
        at = np.searchsorted(time, times[rng.random(len(times)) >= way.lost])
        received[np.clip(at, 0, len(time) - 1), j] = True
    return received
