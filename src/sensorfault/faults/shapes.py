"""The eight fault kinds, each a function of one channel's measurements.

A shape takes the N measurements of a channel in order, without held repetitions, and returns the faulty values of the n
affected ones. Kinds as in Sharma, Golubchik & Govindan, "Sensor faults: detection methods and prevalence in real-world
datasets" (2010), and Min et al. (2021), section 2.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

SPIKE_EVERY = 10  # mean number of measurements from one spike to the next in a longer spike fault
_SAME_TIME_S = 1e-9  # times closer than this are equal


@dataclass(frozen=True)
class Struck:
    """The measurements of one channel and which of them the fault affects.

    `time` [s] and `value` [SI] are all N measurements, `at` the affected ones in order, `onset_s` the start of the
    fault, `size` its magnitude in SI (offset, offset/s, standard deviation, factor or seconds).
    """

    time: Float[np.ndarray, " N"]
    value: Float[np.ndarray, " N"]
    at: Int[np.ndarray, " n"]
    onset_s: float
    size: float
    rng: np.random.Generator

    @property
    def t(self) -> Float[np.ndarray, " n"]:
        """Times of the affected measurements [s]."""
        return self.time.take(self.at)

    @property
    def x(self) -> Float[np.ndarray, " n"]:
        """Their healthy values."""
        return self.value.take(self.at)


Shape = Callable[[Struck], Float[np.ndarray, " n"]]


def offset(s: Struck) -> Float[np.ndarray, " n"]:
    """Offset, and a spike at its samples: y = x + b."""
    return s.x + s.size


def drift(s: Struck) -> Float[np.ndarray, " n"]:
    """A ramp from the onset to the end of the fault: y = x + r (t - t0)."""
    return s.x + s.size * (s.t - s.onset_s)


def jam(s: Struck) -> Float[np.ndarray, " n"]:
    """New measurements arrive, but all repeat the last one before the onset (the first one if there is none before)."""
    last_healthy = max(s.at[0] - 1, 0)
    return np.full(len(s.at), s.value[last_healthy])


def miss(s: Struck) -> Float[np.ndarray, " n"]:
    """No measurement arrives."""
    return np.full(len(s.at), np.nan)


def noise(s: Struck) -> Float[np.ndarray, " n"]:
    """Added white noise, one draw per measurement: y = x + N(0, σ²)."""
    return s.x + s.size * s.rng.standard_normal(len(s.at))


def scale(s: Struck) -> Float[np.ndarray, " n"]:
    """A wrong scale factor: y = k x."""
    return s.x * s.size


def delay(s: Struck) -> Float[np.ndarray, " n"]:
    """Each measurement shows the latest one that is at least `size` seconds old: y(t) = x(t - d)."""
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
    """The spikes of a longer spike fault: the first measurement, then single ones, never two in a row.

    Gaps are uniform from 2 to 2 SPIKE_EVERY - 2 measurements.
    """
    gaps = rng.integers(2, 2 * SPIKE_EVERY - 1, size=len(within))
    steps = np.concatenate(([0], np.cumsum(gaps)))
    return within.take(steps[steps < len(within)])
