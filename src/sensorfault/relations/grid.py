"""Signals on a common grid of 5 Hz: values, integrals and vectors turned into the local frame; NaN across holes."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.relations.signals import Signal

Kept = TypeVar("Kept")
STEP_S = 0.2  # of the grid
PAUSE_S = 1.0  # nothing at all was recorded for longer: the recorder paused
EXACT_S = 1e-6  # times that are closer are the same: a clock may begin anywhere
STALE_S, STALE_PERIODS = 1.5, 3.1  # a longer gap between two measurements is a hole: no window may span it
LONE = frozenset({"barometer", "gnss.height", "depth"})
GRAVITY = 9.80665  # [m/s^2]


def pieces_of(signals: dict[str, Signal]) -> list[tuple[float, float]]:
    """When something was recorded: start and end of each piece between two pauses [s]."""
    if not signals:
        return []
    often = min(signals.values(), key=lambda signal: signal.period_s)
    pause_s = max(PAUSE_S, STALE_PERIODS * often.period_s)
    times = [signal.time for signal in signals.values()]
    if (np.diff(often.time) <= pause_s).all():  # then the others matter only before and after it
        first, last = often.time[[0, -1]]
        times = [often.time, *(time[(time < first) | (time > last)] for time in times)]
    time = np.unique(np.concatenate(times))
    cut = np.flatnonzero(np.diff(time) > pause_s)
    return list(zip(time[np.r_[0, cut + 1]].tolist(), time[np.r_[cut, len(time) - 1]].tolist(), strict=True))


@dataclass
class Grid:
    """One piece of a log on T ticks. Results are kept, since several relations ask for the same.

    `facts`: what was learned of the vehicle, such as the gain of its steering.
    """

    signals: dict[str, Signal]
    start_s: float
    end_s: float
    facts: dict[str, float] = field(default_factory=dict)
    _kept: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        count = int(np.ceil((self.end_s - self.start_s - EXACT_S) / STEP_S)) - 1
        self.time: Float[np.ndarray, " T"] = self.start_s + STEP_S * np.arange(1, max(count, 0) + 1)

    def __contains__(self, key: str) -> bool:
        return key in self.signals

    def hole(self, key: str) -> Bool[np.ndarray, " T"]:
        """Ticks that lie in a hole of the signal, before its first or after its last measurement."""
        signal = self.signals[key]
        stale = max(STALE_S, STALE_PERIODS * signal.period_s)
        after = np.clip(np.searchsorted(signal.time, self.time - EXACT_S), 1, len(signal.time) - 1)
        gap = signal.time[after] - signal.time[after - 1]
        first, last = signal.time[0] - EXACT_S, signal.time[-1] + EXACT_S
        return np.asarray((gap > stale + EXACT_S) | (self.time < first) | (self.time > last))

    def put(self, key: str, value: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "T k"]:
        """Numbers at the times of a signal, drawn between measurements onto the ticks."""
        on: Float[np.ndarray, "T k"] = np.stack(
            [np.interp(self.time, self.signals[key].time, column) for column in value.T], axis=1
        )
        on[self.hole(key)] = np.nan
        return on

    def value(self, key: str) -> Float[np.ndarray, "T k"]:
        """The signal; of heights the median of three neighbours, so that one odd sample moves nothing else."""
        signal = self.signals[key]
        return self.keep(
            "v " + key, lambda: self.put(key, _without_lone(signal) if signal.role in LONE else signal.value)
        )

    def integral(self, key: str) -> Float[np.ndarray, "T k"]:
        """Its integral since the piece began."""
        return self.keep("i " + key, lambda: self.put(key, integrated(self.signals[key].time, self.signals[key].value)))

    def keep(self, name: str, make: Callable[[], Kept]) -> Kept:
        """What `make` returns, made once."""
        if name not in self._kept:
            self._kept[name] = make()
        kept: Kept = self._kept[name]
        return kept


def _without_lone(signal: Signal) -> Float[np.ndarray, "n k"]:
    """Median of each measurement and its two neighbours."""
    x = signal.value
    if len(x) < 3:
        return x
    return np.asarray(np.concatenate([x[:1], np.median(np.stack([x[:-2], x[1:-1], x[2:]]), axis=0), x[-1:]]))


def integrated(time: Float[np.ndarray, " n"], value: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "n k"]:
    """Trapezoids from the first measurement on; a hole adds nothing."""
    step = np.diff(time)
    if len(step):
        step = np.where(step > max(STALE_S, STALE_PERIODS * float(np.median(step))), 0.0, step)
    area = np.nan_to_num((value[1:] + value[:-1]) / 2) * step[:, None]
    return np.concatenate([np.zeros((1, value.shape[1])), np.cumsum(area, axis=0)])


def unwrapped(angle: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """An angle without its jumps of a whole turn; NaN stays."""
    there = np.isfinite(angle)
    out = angle.copy()
    out[there] = np.unwrap(angle[there])
    return out


def wrapped(angle: Float[np.ndarray, "n *k"]) -> Float[np.ndarray, "n *k"]:
    """An angle between -pi and pi."""
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)


def to_local(attitude: Float[np.ndarray, "n 3"], vector: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """Body (forward, right, down) to north, east, down by roll, pitch, yaw [rad] (Groves 2.22)."""
    (r, p, y), (a, b, c) = attitude.T, vector.T
    sr, cr, sp, cp, sy, cy = np.sin(r), np.cos(r), np.sin(p), np.cos(p), np.sin(y), np.cos(y)
    north = cp * cy * a + (sr * sp * cy - cr * sy) * b + (cr * sp * cy + sr * sy) * c
    east = cp * sy * a + (sr * sp * sy + cr * cy) * b + (cr * sp * sy - sr * cy) * c
    down = -sp * a + sr * cp * b + cr * cp * c
    return np.stack([north, east, down], axis=1)


def angle_rates(
    roll: Float[np.ndarray, " n"], pitch: Float[np.ndarray, " n"], rate: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, "n 3"]:
    """Rates of roll, pitch and yaw from a gyro in the body frame (Groves 2.58)."""
    p, q, r = rate.T
    turn = np.sin(roll) * q + np.cos(roll) * r
    cos = np.maximum(np.cos(pitch), 0.2)
    return np.stack(
        [p + np.tan(np.clip(pitch, -1.3, 1.3)) * turn, np.cos(roll) * q - np.sin(roll) * r, turn / cos], axis=1
    )
