"""Exact repeats of a sensor that else does not repeat, or that repeats while the vehicle moves; rest is not frozen."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding, device_of, runs
from sensorfault.relations.signals import Signal

REPEATS, REPEAT_TURN_RAD, REPEAT_S = 8, 1.0, 3.0
MOVED_M = 20.0  # a place that repeats while the vehicle goes so far is frozen
# Sensors that may well repeat: what they measure can stand still, or they are coarse.
_MAY_REST = frozenset(f"gnss.{what}" for what in ("position", "height", "speed", "velocity", "climb")) | {
    *("wheel", "depth", "steering", "dvl", "barometer", "airspeed"),
}
_MOVE_WITH_IT = frozenset({"gnss.position", "gnss.velocity", "dvl", "heading"})


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of every sensor but an estimated attitude and a course, which repeats while a vehicle stands."""
    for signal in grid.signals.values():
        if signal.role not in ("attitude", "gnss.course"):
            yield from _repeats(grid, signal)


def _repeats(grid: Grid, signal: Signal) -> Iterator[Finding]:
    value, time = signal.value, signal.time
    if len(value) < 20:
        return
    same = np.r_[False, np.logical_and.reduce([x[1:] == x[:-1] for x in value.T])]
    if same[1:].all():
        return
    found = list(runs(np.arange(len(time), dtype=float), same, 1.0))
    if not found:
        return
    turned, moved = _turned(grid, time), _moved(grid, time, signal)
    usual = sorted([last - first + 1 for first, last in found] + [1])[-2]
    lively, may_rest = same.mean() < 0.5, signal.role in _MAY_REST
    for first, last in found:
        count, lasts = last - first + 1, float(time[last] - time[first - 1])
        if count < REPEATS or lasts < REPEAT_S:
            continue
        turning = turned is not None and turned[last] - turned[first - 1] > REPEAT_TURN_RAD and not may_rest
        moving = moved is not None and moved[last] - moved[first - 1] > max(MOVED_M, lasts)
        resting = may_rest and float(np.abs(value[first]).max()) < 1e-9
        odd = lively and count > 10 * usual and count >= 2 * REPEATS and not resting
        if turning or (moving and signal.role in _MOVE_WITH_IT) or odd:
            start_s = float(time[first - 1])
            yield Finding(device_of(signal), start_s, float(time[last]), "exact repeats", lasts, REPEAT_S, "frozen")


def _turned(grid: Grid, time: np.ndarray) -> np.ndarray | None:
    """How far the gyro has turned in all [rad]."""
    if "gyro" not in grid:
        return None
    gyro = grid.signals["gyro"]
    step = np.minimum(np.diff(gyro.time, prepend=gyro.time[0]), 0.5)
    return np.asarray(np.interp(time, gyro.time, np.cumsum(np.linalg.norm(gyro.value, axis=1) * step)))


def _moved(grid: Grid, time: np.ndarray, signal: Signal) -> np.ndarray | None:
    """How far the vehicle went, by another device [m]."""
    for key in ("wheel", "dvl", "gnss.speed", "gnss.velocity"):
        if key in grid and key != signal.key:
            other = grid.signals[key]
            step = np.minimum(np.diff(other.time, prepend=other.time[0]), 2.0)
            return np.asarray(np.interp(time, other.time, np.cumsum(np.linalg.norm(other.value, axis=1) * step)))
    return None
