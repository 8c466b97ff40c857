"""A log in numbers, sensor by sensor: rates, gaps, held values; of a long log part by part."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.logs.held import any_of
from sensorfault.logs.pauses import GAP, Pauses, pauses_of, recorded
from sensorfault.logs.table import Log

STEADY = 1.5  # a step up to so many usual ones has no measurement missing in it
MOST_STEPS = 1 << 20  # the usual step of a sensor is that of so many from the beginning


@dataclass(frozen=True)
class SensorSummary:
    """One sensor. Rate in new measurements per second while none is missing.

    `held`: share of its values that repeat the last one.
    `gaps`: times without a measurement longer than three usual periods, pauses of the whole recording left out; the
    longest lasts `longest_gap_s` from `gap_at_s`. `missing`: share of the ticks without any value. Unknown numbers are
    None, as the rate of a sensor with fewer than two measurements.
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
    """Each sensor of a log."""
    summing = Summing()
    summing.take(log)
    return summing.sensors


class Summing:
    """Sums up consecutive parts of one log. `first`: the first of them. `rows`, `end_s`, `pauses`: of all so far."""

    def __init__(self) -> None:
        self.first: Log | None = None
        self.rows, self.end_s = 0, 0.0
        self.pauses: Pauses = np.zeros((0, 2))
        self._sums: list[_Sum] = []

    def take(self, part: Log) -> None:
        """The next part."""
        if self.first is None:
            self.first = part
            self._sums = [_Sum(sensor.name, part) for sensor in part.sensors]
        ticks = np.append(self.end_s, part.time) if self.rows else part.time
        self.pauses = np.concatenate([self.pauses, pauses_of(ticks, self.first.period_s)])
        time = recorded(part.time, self.pauses)
        for one in self._sums:
            one.take(part, time)
        self.rows += len(part)
        self.end_s = float(part.time[-1]) if len(part) else self.end_s

    @property
    def sensors(self) -> tuple[SensorSummary, ...]:
        """What is known of each sensor so far."""
        return tuple(one.summary() for one in self._sums)


class _Sum:
    """One sensor, so far. A part may have its channels in any place, but has them all."""

    def __init__(self, name: str, first: Log) -> None:
        self._name = name
        self._columns = list(first.of(name))
        self._channels = [first.channels[i] for i in self._columns]
        self._rows = self._present = self._measurements = self._gaps = 0
        self._steady, self._steady_s = 0, 0.0  # steps without a measurement missing, and how long they last together
        self._early: list[Float[np.ndarray, " k"]] = []  # steps before the usual one is known
        self._usual_s: float | None = None
        self._longest_s, self._longest_at_s = 0.0, np.nan
        self._last: Float[np.ndarray, "1 2"] = np.zeros((0, 2))

    def take(self, part: Log, recorded_s: Float[np.ndarray, " T"]) -> None:
        """`recorded_s`: the time of each tick without the pauses before it."""
        value, fresh = part.value[:, self._columns], part.fresh[:, self._columns]
        self._rows += len(part)
        self._present += int(any_of(np.isfinite(value)).sum())
        new = any_of(fresh)
        if not new.any():
            return
        self._measurements += int(new.sum())
        at = np.concatenate([self._last, np.column_stack([recorded_s[new], part.time[new]])])
        self._last = at[-1:]
        steps = np.diff(at[:, 0])
        if len(steps) and steps.max() > self._longest_s:
            worst = int(np.argmax(steps))
            self._longest_s, self._longest_at_s = float(steps[worst]), float(at[worst, 1])
        if self._usual_s is not None:
            self._count(steps, self._usual_s)
            return
        self._early.append(steps)
        if self._measurements > MOST_STEPS:
            steps = np.concatenate(self._early)
            self._usual_s = float(np.median(steps))
            self._count(steps, self._usual_s)
            self._early = []

    def summary(self) -> SensorSummary:
        early = np.concatenate(self._early) if self._early else np.zeros(0)
        before = self._gaps, self._steady, self._steady_s
        self._count(early, self._usual_s or (float(np.median(early)) if len(early) else 0.0))
        gaps, steady, steady_s = self._gaps, self._steady, self._steady_s
        self._gaps, self._steady, self._steady_s = before  # more parts may come
        present, rows = self._present, self._rows
        return SensorSummary(
            name=self._name,
            channels=tuple(channel.name for channel in self._channels),
            units=tuple(channel.unit for channel in self._channels),
            measurements=self._measurements,
            rate_hz=steady / steady_s if steady_s else None,
            gaps=gaps,
            longest_gap_s=self._longest_s if gaps else None,
            gap_at_s=self._longest_at_s if gaps else None,
            held=1 - self._measurements / present if present else 0.0,
            missing=1 - present / rows if rows else 1.0,
        )

    def _count(self, steps: Float[np.ndarray, " k"], usual_s: float) -> None:
        steady = steps[steps <= STEADY * usual_s]
        self._gaps += int((steps > GAP * usual_s).sum())
        self._steady += len(steady)
        self._steady_s += float(steady.sum())
