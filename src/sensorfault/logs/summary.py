"""What a log holds, sensor by sensor: rates, gaps, held values."""

from dataclasses import dataclass

import numpy as np

from sensorfault.logs.clock import GAP
from sensorfault.logs.held import share_old
from sensorfault.logs.table import Log


@dataclass(frozen=True)
class SensorSummary:
    """One sensor. Rate in new measurements a second; `held`: share of its values that only repeat the last one.

    `gaps`: times without a measurement that are longer than three usual periods; `longest_gap_s` begins at `gap_at_s`.
    What is not known is None: of a sensor that measured less than twice, the rate.
    """

    name: str
    channels: tuple[str, ...]
    units: tuple[str, ...]
    measurements: int
    rate_hz: float | None
    gaps: int
    longest_gap_s: float | None
    gap_at_s: float | None
    held: float
    missing: float


def summarise(log: Log) -> tuple[SensorSummary, ...]:
    """Each sensor of a log. `missing`: share of the ticks of its time that are without any value of it."""
    return tuple(_sensor(log, sensor.name) for sensor in log.sensors)


def _sensor(log: Log, name: str) -> SensorSummary:
    columns = list(log.of(name))
    value, fresh = log.value[:, columns], log.fresh[:, columns]
    at = log.time[fresh.any(axis=1)]
    steps = np.diff(at)
    period = float(np.median(steps)) if len(steps) else 0.0
    long = steps > GAP * period
    worst = int(np.argmax(steps)) if long.any() else None
    return SensorSummary(
        name=name,
        channels=tuple(log.channels[i].name for i in columns),
        units=tuple(log.channels[i].unit for i in columns),
        measurements=len(at),
        rate_hz=1 / period if period else None,
        gaps=int(long.sum()),
        longest_gap_s=None if worst is None else float(steps[worst]),
        gap_at_s=None if worst is None else float(at[worst]),
        held=share_old(value, fresh),
        missing=float(np.mean(~np.isfinite(value).any(axis=1))) if len(value) else 1.0,
    )
