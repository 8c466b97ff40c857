"""The eight fault kinds, each a function of one channel's measurements.

A shape sees the N measurements of a channel in order, held repetitions left out, and answers what the n struck ones
read instead. Kinds as in Sharma, Golubchik & Govindan, "Sensor faults: detection methods and prevalence in real-world
datasets" (2010), and Min et al. (2021), section 2.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

SPIKE_EVERY = 10  # measurements from one spike of a longer short to the next, on average
_SAME_TIME_S = 1e-9  # two clock readings closer than this are one


@dataclass(frozen=True)
class Struck:
    """The measurements of one channel and which of them the fault strikes.

    `time` [s] and `value` [SI] are all N measurements, `at` the struck ones in order, `onset_s` the start of the fault,
    `size` its magnitude in SI (offset, offset/s, standard deviation, factor or seconds).
    """

    time: Float[np.ndarray, " N"]
    value: Float[np.ndarray, " N"]
    at: Int[np.ndarray, " n"]
    onset_s: float
    size: float
    rng: np.random.Generator

    @property
    def t(self) -> Float[np.ndarray, " n"]:
        """When the struck measurements were made [s]."""
        return self.time.take(self.at)

    @property
    def x(self) -> Float[np.ndarray, " n"]:
        """What they would have read."""
        return self.value.take(self.at)


Shape = Callable[[Struck], Float[np.ndarray, " n"]]


def offset(s: Struck) -> Float[np.ndarray, " n"]:
    """Bias, and short at its spikes: y = x + b."""
    return s.x + s.size


def drift(s: Struck) -> Float[np.ndarray, " n"]:
    """A ramp that grows until the fault ends and is then gone: y = x + r (t - t0)."""
    return s.x + s.size * (s.t - s.onset_s)


def jam(s: Struck) -> Float[np.ndarray, " n"]:
    """New measurements keep coming and all repeat the last one before onset (the first of all, if none was before)."""
    last_healthy = max(s.at[0] - 1, 0)
    return np.full(len(s.at), s.value[last_healthy])


def miss(s: Struck) -> Float[np.ndarray, " n"]:
    """Nothing arrives."""
    return np.full(len(s.at), np.nan)


def noise(s: Struck) -> Float[np.ndarray, " n"]:
    """White noise on top, one draw a measurement: y = x + N(0, σ²)."""
    return s.x + s.size * s.rng.standard_normal(len(s.at))


def scale(s: Struck) -> Float[np.ndarray, " n"]:
    """A wrong scale factor: y = k x."""
    return s.x * s.size


def delay(s: Struck) -> Float[np.ndarray, " n"]:
    """Each measurement shows the latest one that was `size` seconds old or older: y(t) = x(t - d)."""
    seen = np.searchsorted(s.time, s.t - s.size + _SAME_TIME_S, side="right") - 1
    return s.value.take(np.maximum(seen, 0))


SHAPES: dict[str, Shape] = {
    "spike": offset,
    "offset": offset,
    "drift": drift,
    "frozen": jam,
    "missing": miss,
    "noise": noise,
    "scale": scale,
    "delay": delay,
}


def spikes(within: Int[np.ndarray, " m"], rng: np.random.Generator) -> Int[np.ndarray, " n"]:
    """Which of these measurements a longer short strikes: the first, then single ones, never two in a row.

    Gaps are 2 .. 2 SPIKE_EVERY - 2 measurements, uniformly.
    """
    gaps = rng.integers(2, 2 * SPIKE_EVERY - 1, size=len(within))
    steps = np.concatenate(([0], np.cumsum(gaps)))
    return within.take(steps[steps < len(within)])
