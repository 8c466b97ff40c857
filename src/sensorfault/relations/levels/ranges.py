"""A satellite whose range does not fit the place that all others give."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding, device_of, runs
from sensorfault.relations.signals import RANGE_ROLE, Signal

TIMES, LEAST_M = 10.0, 15.0  # of the usual error of a range; no smaller error is a fault
EPOCHS, JOIN_S = 3, 10.0
TEST = "range against all other satellites"
LARGEST = "range.largest"  # fact of a vehicle: the largest error of a range in healthy drives [m]
SPARE = 1.5


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of each satellite."""
    sky = _sky(grid)
    limit = LEAST_M
    if LARGEST in grid.facts:
        limit = max(limit, SPARE * grid.facts[LARGEST])
    elif sky:
        limit = max(limit, TIMES * float(np.median(np.abs(np.concatenate([signal.value[:, 0] for signal in sky])))))
    for signal in sky:
        off = np.abs(signal.value[:, 0])
        for first, last in runs(signal.time, off > limit, JOIN_S):
            if (off[first : last + 1] > limit).sum() >= EPOCHS:
                start_s, end_s = float(signal.time[first]), float(signal.time[last])
                yield Finding(device_of(signal), start_s, end_s, TEST, float(off[first : last + 1].max()), limit)


def largest(grid: Grid) -> dict[str, float]:
    """What a healthy drive teaches: the largest error of any range [m]."""
    errors = [float(np.abs(signal.value).max()) for signal in _sky(grid)]
    return {LARGEST: max(errors)} if errors else {}


def _sky(grid: Grid) -> list[Signal]:
    return [signal for signal in grid.signals.values() if signal.role == RANGE_ROLE]
