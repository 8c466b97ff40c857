"""A flight from fix to fix, split into a training part and a test part, and the ramps injected into its height."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.logs.table import Log, Sensor
from sensorfault.training.fixes import Fixes
from sensorfault.vehicles.fixed_wing import Roles, roles

LEARN = 0.7  # share of the flight for training
SLOPES = tuple(round(0.1 * i, 1) for i in range(1, 11))  # [m/s]
EVERY_S, FAULTY_S = 30.0, 80.0  # between onsets, and length of a fault (or to the end): 150 and 400 steps at 5 Hz
LEAST_S = 10.0  # shortest fault [s]


@dataclass(frozen=True)
class Flown:
    """A flight in which every row is a new height; the other inputs keep their last measured value.

    `start`: the first row of the test part.
    """

    log: Log
    start: int

    @classmethod
    def of(cls, flight: Log) -> "Flown":
        """From a whole flight on a faster clock.

        Raises:
            LogError: too few heights.
        """
        found = roles(flight)
        columns = [found.height, found.vertical, found.barometric, found.inertial, *found.inputs]
        kept = flight.select(flight.channels[c].path for c in columns if c is not None)
        fixes = Fixes.of(kept, 0, tuple(range(1, len(kept.channels))))
        value = np.column_stack([fixes.height, fixes.inputs])
        sensors = tuple(Sensor(sensor.name, fixes.period_s) for sensor in kept.sensors)
        log = replace(kept, time=fixes.time, value=value, fresh=np.isfinite(value), sensors=sensors)
        return cls(log, int(np.searchsorted(fixes.time, fixes.time[0] + LEARN * log.duration_s)))

    @property
    def roles(self) -> Roles:
        """Columns of `log`."""
        return roles(self.log)

    @property
    def learn(self) -> Log:
        """The training part."""
        return self.log.between(end_s=float(self.log.time[self.start]))

    @property
    def judge(self) -> Log:
        """The test part."""
        return self.log.between(float(self.log.time[self.start]))


@dataclass(frozen=True)
class Ramps:
    """Cell 0 has no fault; then every slope at every onset.

    `height`: of each cell [m]; `slope` [m/s], `onset` [row] and `faulty` [rows]: of its ramp.
    """

    log: Log
    height: Float[np.ndarray, "N T"]
    slope: Float[np.ndarray, " N"]
    onset: Int[np.ndarray, " N"]
    faulty: int

    @classmethod
    def on(cls, log: Log, slopes: tuple[float, ...] = SLOPES) -> "Ramps":
        """Onsets every EVERY_S, as many as fit."""
        every, faulty, least = (round(span / log.sensors[0].period_s) for span in (EVERY_S, FAULTY_S, LEAST_S))
        onsets = np.arange(every, len(log) - least, every)
        cells = [(0.0, 0), *((slope, int(onset)) for slope in slopes for onset in onsets)]
        slope, onset = (np.array(x) for x in zip(*cells, strict=True))
        since = np.maximum(log.time[None] - log.time[onset][:, None], 0.0)
        return cls(log, log.value[:, 0] + slope[:, None] * since, slope, onset, faulty)

    @property
    def logs(self) -> list[Log]:
        """One log for each cell."""
        columns = [np.column_stack([height, self.log.value[:, 1:]]) for height in self.height]
        return [replace(self.log, value=value) for value in columns]

    def span(self, cell: int) -> slice:
        """The rows of a cell that count as faulty."""
        return slice(int(self.onset[cell]), min(int(self.onset[cell]) + self.faulty, len(self.log)))


class Count(NamedTuple):
    """Alarms of one monitor for all ramps of one slope, or for the same spans without a ramp.

    `rate`: share of faulty steps with an alarm; `delay`: steps to the first alarm, or the whole span if there is none;
    `missed`: share of the ramps without an alarm. Means over the ramps.
    """

    rate: float
    delay: float
    missed: float


def count(ramps: Ramps, alarm: Bool[np.ndarray, "N T"], cells: Int[np.ndarray, " n"], fault: bool = True) -> Count:
    """Count over these cells; with `fault` False, over the same spans of the flight without a fault."""
    spans = [alarm[cell if fault else 0, ramps.span(int(cell))] for cell in cells]
    first = [int(np.argmax(each)) if each.any() else len(each) for each in spans]
    rate, missed = np.mean([each.mean() for each in spans]), np.mean([not each.any() for each in spans])
    return Count(float(rate), float(np.mean(first)), float(missed))
