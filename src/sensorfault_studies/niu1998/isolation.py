"""A real arm: faults of all kinds on twelve sensors, one at a time, and which sensor is isolated first."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.core.verdicts import UNKNOWN
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault_studies.niu1998.fleet import Result, watch, with_limits
from sensorfault_studies.niu1998.schunk import JOINTS

WINDOW, ONSET, LASTING = 150, 100, 25  # ticks: length of a stretch of a run, onset and duration of its fault
CALM = 10  # ticks before the onset without an alarm
RATES = {"far1e-2": 1e-2, "far1e-3": 1e-3}  # share of healthy samples with any of the twelve over its limit
SENSORS = 2 * JOINTS
FIFTH = 5  # the last fifth of the runs has another motion
GROUPS = {"tachometers": slice(0, JOINTS), "encoders": slice(JOINTS, SENSORS), "all": slice(0, SENSORS)}
SIZES = (3.0, 5.0, 10.0, 20.0)
OFFSETS = ("spike", "offset", "drift", "noise")  # sizes in one-step errors (of a drift: a sample)
OTHERS = {"frozen": LASTING, "scale": 1.5, "delay": 5, "missing": LASTING}  # ticks; a factor; ticks; ticks


@dataclass(frozen=True)
class Runs:
    """The use of the runs: `learned` for training, `other` for the limits, `judged` for the tests."""

    learned: tuple[Log, ...]
    other: tuple[Log, ...]
    judged: tuple[Log, ...]

    @classmethod
    def of(cls, runs: Sequence[Log], seed: int) -> "Runs":
        """A half, a quarter and a quarter, each with all motions; the training runs in random order."""
        order = np.random.default_rng(seed).permutation(len(runs[::2]))
        return cls(tuple(runs[2 * i] for i in order), tuple(runs[1::4]), tuple(runs[3::4]))

    @classmethod
    def of_another_motion(cls, runs: Sequence[Log]) -> "Runs":
        """The last fifth of the runs for the tests; its motion occurs in no other run."""
        known = runs[: -len(runs) // FIFTH]
        order = np.random.default_rng(0).permutation(len(known[::2]))
        return cls(tuple(known[2 * i] for i in order), tuple(known[1::2]), tuple(runs[len(known) :]))


@dataclass(frozen=True)
class Trial:
    """One fault on one sensor in one stretch of a run."""

    kind: str
    size: float  # in one-step errors, or as OTHERS says
    column: int
    log: Log


def stretches(runs: Sequence[Log]) -> list[Log]:
    """Consecutive stretches of WINDOW ticks; the last tick of a run is left out, since it has no torque."""
    return [
        replace(run, time=run.time[rows], value=run.value[rows], fresh=run.fresh[rows])
        for run in runs
        for rows in (slice(first, first + WINDOW) for first in range(0, len(run) - WINDOW, WINDOW))
    ]


def trials(healthy: Sequence[Log], unit: Float[np.ndarray, " C"], each: int, seed: int, quick: bool) -> list[Trial]:
    """`each` of every kind and size on every sensor, in random stretches; `unit`: one-step error of a channel [SI].

    A frozen fault starts where the next measurement would have been at least five units away.
    """
    rng = np.random.default_rng(seed)
    sizes = (5.0,) if quick else SIZES
    wanted = [(kind, size) for kind in OFFSETS for size in sizes] + list(OTHERS.items())
    found = []
    for kind, size in wanted:
        for column in range(SENSORS):
            for log in _drawn(healthy, column, 5 * unit[column] if kind == "frozen" else 0.0, each, rng):
                faulty = inject(log, [_fault(kind, float(size), log, column, unit[column], rng)], seed).log
                found.append(Trial(kind, float(size), column, faulty))
    return found


def _drawn(healthy: Sequence[Log], column: int, least: float, many: int, rng: np.random.Generator) -> Iterator[Log]:
    """Stretches in which this channel changes by at least `least` from the sample before the onset to the onset."""
    for i in rng.permutation(len(healthy)):
        before, at = healthy[i].value[ONSET - 1 : ONSET + 1, column]
        if many and abs(at - before) >= least:
            many -= 1
            yield healthy[i]


def _fault(kind: str, size: float, log: Log, column: int, unit: float, rng: np.random.Generator) -> Fault:
    channel, tick_s = log.channels[column], log.period_s
    offset = size * unit * float(rng.choice((-1.0, 1.0)))
    magnitude = {
        "spike": offset,
        "offset": offset,
        "drift": offset / tick_s,
        "noise": abs(offset),
        "scale": size,
        "delay": size * tick_s,
    }.get(kind, 0.0)
    lasting = 0.0 if kind == "spike" else (LASTING - 0.5) * tick_s
    return Fault(kind, channel.sensor, channel.name, float(log.time[ONSET]), lasting, magnitude)


@dataclass(frozen=True)
class Isolated:
    """Results of N trials. `calm`: no alarm before. `named`: sensors of the first alarm. `delay`: ticks, NaN: none.

    `right`: the first alarm names the faulty sensor and no other.
    """

    calm: Bool[np.ndarray, " N"]
    right: Bool[np.ndarray, " N"]
    named: Bool[np.ndarray, "N 12"]
    delay: Float[np.ndarray, " N"]


def isolated(result: Result, column: Int[np.ndarray, " N"]) -> Isolated:
    """Results by the first alarm during the fault."""
    fault = result.fault[:, :, :SENSORS]
    calm = ~np.asarray(fault[:, ONSET - CALM : ONSET].any(axis=(1, 2)))
    during = fault[:, ONSET : ONSET + LASTING]
    alarm = np.asarray(during.any(axis=2))
    at = alarm.argmax(axis=1)
    rows = np.arange(len(fault))
    named = during[rows, at]
    right = named[rows, column] & (named.sum(axis=1) == 1)
    return Isolated(calm, right, named, np.where(alarm.any(axis=1), at, np.nan))


def missed(result: Result, column: Int[np.ndarray, " N"]) -> Bool[np.ndarray, " N"]:
    """Trials in which a missing sensor was unknown throughout, and no sensor was named."""
    during = result.channel[:, ONSET : ONSET + LASTING, :SENSORS]
    unknown = np.asarray(during[np.arange(len(during)), :, column] == UNKNOWN)
    return np.asarray(unknown.all(axis=1) & ~result.fault[:, ONSET : ONSET + LASTING].any(axis=(1, 2)))


def one_step_error(result: Result) -> Float[np.ndarray, "12"]:
    """RMS of each sensor's residual where it was tested [SI]."""
    residual = np.where(result.tested, result.residual, np.nan)[:, :, :SENSORS]
    return np.asarray(np.sqrt(np.nanmean(residual**2, axis=(0, 1))))


@dataclass(frozen=True)
class Calibrated:
    """A model with limits from healthy stretches that it was not trained on.

    `unit`: RMS one-step error of each channel [SI]. `limits`: by the names of RATES, equal rates for all twelve
    sensors.
    """

    uncalibrated: Model
    unit: Float[np.ndarray, " C"]
    limits: Mapping[str, Float[np.ndarray, " C"]]

    @classmethod
    def of(cls, model: Model, healthy: Sequence[Log]) -> "Calibrated":
        """From open-loop scores."""
        many = len(model.channels)
        uncalibrated = with_limits(model, np.full(many, np.inf))
        result = watch(uncalibrated, healthy)
        score, unit = result.score[:, :, :SENSORS], np.ones(many)
        unit[:SENSORS] = one_step_error(result)
        limits = {}
        for name, rate in RATES.items():
            limits[name] = np.full(many, np.inf)
            limits[name][:SENSORS] = np.nanquantile(score, 1 - rate / SENSORS, axis=(0, 1))
        return cls(uncalibrated, unit, limits)
