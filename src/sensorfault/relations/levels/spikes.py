"""One sample of an inertial sensor alone, while the other inertial sensor is quiet: a jolt moves both."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding, device_of, runs
from sensorfault.relations.signals import Signal

SPIKE, QUIET = {"gyro": 20.0, "accelerometer": 40.0}, 5.0  # in usual steps: of the wrong one, of the other
NEAR_S, BLOCK_S = 0.3, 5.0
TEST = "one sample against the usual step"
OTHER = {"gyro": "accelerometer", "accelerometer": "gyro"}


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of each gyro and accelerometer that has a partner in its unit."""
    for signal in grid.signals.values():
        if signal.role not in OTHER:
            continue
        other = grid.signals.get(OTHER[signal.role] + signal.key.removeprefix(signal.role))
        if other is None or len(signal.time) < 50 or len(other.time) < 50:
            continue
        score, partner, limit = _kept(grid, signal), _kept(grid, other), SPIKE[signal.role]
        for first, last in runs(signal.time[1:-1], score > limit, 0.5):
            start_s, end_s = float(signal.time[first + 1]), float(signal.time[last + 1])
            near = (other.time[1:-1] > start_s - NEAR_S) & (other.time[1:-1] < end_s + NEAR_S)
            if near.any() and partner[near].max() < QUIET:
                peak = float(score[first : last + 1].max())
                yield Finding(device_of(signal), start_s, end_s, TEST, peak, limit, "spike")


def _kept(grid: Grid, signal: Signal) -> Float[np.ndarray, " m"]:
    return grid.keep(f"alone {signal.key}", lambda: _score(signal))


def _score(signal: Signal) -> Float[np.ndarray, " m"]:
    """How far each sample stands alone, on the side of both neighbours, over the usual step around it; largest axis."""
    step = np.diff(signal.time)
    close = (step[1:] < 3 * signal.period_s) & (step[:-1] < 3 * signal.period_s)
    size = max(round(BLOCK_S / signal.period_s), 20)
    x = np.ascontiguousarray(signal.value.T)
    back, ahead = x[:, 1:-1] - x[:, :-2], x[:, 1:-1] - x[:, 2:]
    alone = np.where((back * ahead > 0) & close, np.minimum(np.abs(back), np.abs(ahead)), 0.0)
    return np.asarray((alone / np.maximum(_usual(np.abs(back), size), 1e-12)).max(axis=0))


def _usual(step: Float[np.ndarray, "k m"], size: int) -> Float[np.ndarray, "k m"]:
    """What nine of ten steps do not exceed in blocks of about `size`, the largest of a block and its neighbours."""
    blocks = max(step.shape[1] // size, 1)
    short, longer = divmod(step.shape[1], blocks)
    cut = longer * (short + 1)
    parts = step[:, :cut].reshape(len(step), longer, short + 1), step[:, cut:].reshape(len(step), -1, short)
    usual = np.concatenate([np.quantile(part, 0.9, axis=2) for part in parts if part.size], axis=1)
    around = np.pad(usual, ((0, 0), (1, 1)))
    usual = np.maximum(usual, np.maximum(around[:, 2:], around[:, :-2]))
    return np.repeat(usual, [short + 1] * longer + [short] * (blocks - longer), axis=1)
