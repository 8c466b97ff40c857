"""A satellite whose range does not fit the place that all others give."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding, device_of, runs
from sensorfault.relations.signals import RANGE_ROLE

TIMES, LEAST_M = 10.0, 15.0  # of the usual error of a range; no smaller error is a fault
EPOCHS, JOIN_S = 3, 10.0
TEST = "range against all other satellites"


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of each satellite."""
    sky = [signal for signal in grid.signals.values() if signal.role == RANGE_ROLE]
    if not sky:
        return
    limit = max(TIMES * float(np.median(np.abs(np.concatenate([signal.value[:, 0] for signal in sky])))), LEAST_M)
    for signal in sky:
        off = np.abs(signal.value[:, 0])
        for first, last in runs(signal.time, off > limit, JOIN_S):
            if (off[first : last + 1] > limit).sum() >= EPOCHS:
                start_s, end_s = float(signal.time[first]), float(signal.time[last])
                yield Finding(device_of(signal), start_s, end_s, TEST, float(off[first : last + 1].max()), limit)
