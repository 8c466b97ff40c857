"""Ranges whose error is known, to learn from: by the fixes of a log, and by faults injected into it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Report, Sample
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.numerics.innovation import features
from sensorfault.runtime.replay import Numbers
from sensorfault.runtime.runners import replay, samples
from sensorfault.training.labelled import Labelled
from sensorfault.vehicles.underwater import Follower

EVERY_S = 120.0  # one fault on each leader in this time [s]
LONGEST_S = (20.0, 70.0)
OFFSET, DRIFT = (3.0, 10.0), (0.1, 0.25)  # in standard deviations of a range; drift: a second
KINDS = ("frozen", "frozen", "drift", "offset")


@dataclass(frozen=True)
class Lesson:
    """A log and the error of each of the L ranges [m], NaN where unknown."""

    log: Log
    error: Float[np.ndarray, "T L"]


class _Tape(NamedTuple):
    value: Float[Numbers, "T C"]
    variance: Float[Numbers, "T C"]
    noise: Float[Numbers, "T C"]
    valid: Bool[Numbers, "T C"]


def surfaced(log: Log, vehicle: Follower) -> Float[np.ndarray, "T L"]:
    """Error of each range from fix and leader position at its tick [m], equation (26); NaN where one is missing."""
    rows = samples(log.time, log.value, log.fresh)
    expected = np.asarray(jax.jit(jax.vmap(_by_fix, in_axes=(None, 0)))(vehicle, rows))
    ranges = list(vehicle.observed)
    northward, eastward = vehicle.roles.position
    fixed = log.fresh[:, northward] & log.fresh[:, eastward]
    return np.where(fixed[:, None] & log.fresh[:, ranges], log.value[:, ranges] - expected, np.nan)


def _by_fix(vehicle: Follower, sample: Sample) -> Float[Array, " L"]:
    expected = vehicle.expected(vehicle.start(sample)[0], sample)
    return jnp.where(vehicle.ready(sample), expected, jnp.nan)


def submerged(log: Log, columns: Sequence[int]) -> Log:
    """The log with only its first fix, as it is under water."""
    first = int(log.fresh[:, list(columns)].all(axis=1).argmax())
    hidden = np.zeros(log.value.shape, bool)
    hidden[first + 1 :, list(columns)] = True
    return replace(log, value=np.where(hidden, np.nan, log.value), fresh=log.fresh & ~hidden)


def spoiled(lesson: Lesson, vehicle: Follower, sigma_m: float, seed: int) -> Lesson:
    """The same log with random faults on every leader's ranges: frozen, drift and offset."""
    rng = np.random.default_rng([seed, 9])
    log, ranges = lesson.log, list(vehicle.observed)
    faults = [fault for column in ranges for fault in _faults(log, column, sigma_m, rng)]
    done = inject(log, faults, seed).log
    return Lesson(done, lesson.error + np.nan_to_num(done.value[:, ranges] - log.value[:, ranges]))


def _faults(log: Log, column: int, sigma_m: float, rng: np.random.Generator) -> list[Fault]:
    channel, received = log.channels[column], log.time[log.fresh[:, column]]
    unit = float(from_si(1.0, channel.unit))
    faults = []
    for start in np.arange(log.time[0], log.time[-1] - EVERY_S, EVERY_S) + rng.uniform(0, EVERY_S / 3):
        kind, length = str(rng.choice(KINDS)), float(rng.uniform(*LONGEST_S))
        if not ((received >= start) & (received < start + length)).any():
            continue
        size = {"frozen": 0.0, "drift": rng.uniform(*DRIFT), "offset": rng.uniform(*OFFSET)}[kind] * sigma_m * unit
        sign = float(rng.choice((-1, 1)))
        faults.append(Fault(kind, channel.sensor, channel.name, float(start), length, float(sign * size)))
    return faults


def labelled(monitor: Monitor, lessons: Sequence[Lesson], vehicle: Follower) -> list[Labelled]:
    """For each leader the features of its innovations (N, 3) and the error sizes (N,) [m], over all logs."""
    runs = innovations(monitor, lessons, vehicle)
    return [
        Labelled(np.concatenate([features(*run.tape) for run in of]), np.concatenate([np.abs(run.error) for run in of]))
        for of in runs
    ]


@dataclass(frozen=True)
class Run:
    """Innovations with known errors of one leader in one log: `tape` is value [m], variance [m²], noise [m²]."""

    tape: tuple[Float[np.ndarray, " n"], ...]
    error: Float[np.ndarray, " n"]


def innovations(monitor: Monitor, lessons: Sequence[Lesson], vehicle: Follower) -> list[list[Run]]:
    """The runs of each leader, by log."""
    runs: list[list[Run]] = [[] for _ in vehicle.observed]
    for lesson in lessons:
        rows = samples(lesson.log.time, lesson.log.value, lesson.log.fresh)
        tape = _Tape(*(np.asarray(x) for x in _open_loop(monitor, rows)))
        for j, column in enumerate(vehicle.observed):
            known = np.asarray(tape.valid)[:, column] & np.isfinite(lesson.error[:, j])
            runs[j].append(Run(tuple(np.asarray(x)[known, column] for x in tape[:3]), lesson.error[known, j]))
    return runs


@jax.jit
def _open_loop(monitor: Monitor, rows: Sample) -> _Tape:
    return replay(monitor, monitor.init(), rows, _features)[1]


def _features(report: Report) -> _Tape:
    residual = report.residual
    return _Tape(residual.value, jnp.diagonal(residual.cov), residual.noise, residual.valid)
