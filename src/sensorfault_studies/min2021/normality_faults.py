"""Detection by the bicycle filter: position offsets, and motions that no bicycle makes; and false isolations."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.gumbel import gumbel_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch
from sensorfault.faults.motion import Felt, MotionFault, move
from sensorfault.logs.table import Log
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import MOTION, Model
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.residual.bicycle_kalman import BicycleKalman
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import LEAST_SPEED, moving, roles
from sensorfault_studies.findings import Row

WARM_S = 15.0  # time of the test part before the first fault [s]
WITHIN_S = 5.0  # a fault must be detected within this time of its onset [s]
AFTER_S = 3.0  # an alarm of a window may come this long after the motion [s]
BIASES_M = (0.3, 0.5, 1.0, 2.0)
NORMS = ("length", "largest")
# kind, length [s], size as in faults/motion.py
WHEELED = (("wheel slip", 3.0, 1.2), ("wheel slip", 3.0, 0.0))
TURNED = (
    *(("side slip", 2.0, size) for size in (0.5, 1.0, 2.0)),
    ("side slip", 10.0, 1.5),
    *(("spin", 2.0, size) for size in (0.5, 1.0)),
)


@dataclass(frozen=True)
class Judged:
    """A drive, the model fitted on its first part, the test part, and the columns that a motion affects."""

    data: str
    learn: Log
    rest: Log
    model: Model
    felt: Felt

    @property
    def filter(self) -> BicycleKalman:
        found = self.model.monitor.residual
        assert isinstance(found, BicycleKalman)
        return found


def felt(learn: Log) -> Felt:
    """The columns that a motion affects, by their roles, and the mounting if the drive shows it."""
    found = roles(learn)
    assert found.position is not None
    assert found.velocity is not None
    wheels = tuple(i for i, c in enumerate(learn.channels) if c.sensor in ("speed", "wheels"))
    if wheels:  # the drive is too straight to fit the mounting: only the wheels slip
        return Felt(found.position, found.velocity, found.polar, wheels=wheels)
    mounted = fit_mounting(learn, found)
    axes = [tuple(float(x) for x in axis) for axis in (mounted.forward, mounted.left, mounted.axis)]
    return Felt(found.position, found.velocity, found.polar, found.accelerometer, found.gyro, (), *axes)  # type: ignore[arg-type]


def onsets(judged: Judged, count: int, length_s: float, fast: float = 0.0) -> list[float]:
    """Onsets spread evenly over the test part, where the car is faster than `fast` from onset to end."""
    time = judged.rest.time
    found = roles(judged.rest)
    times = np.linspace(time[0] + WARM_S, time[-1] - length_s - WITHIN_S, 3 * count)
    if fast:
        going = moving(judged.rest, found, fast)
        gap = 3 * float(np.median(np.diff(going)))
        good = [t for t in times if _covered(going, t, t + length_s, gap)]
    else:
        good = list(times)
    return [float(t) for t in (good[:: max(len(good) // count, 1)][:count] if good else [])]


def _covered(going: Float[np.ndarray, " N"], start: float, end: float, gap: float) -> bool:
    inside = going[(going >= start - gap) & (going <= end + gap)]
    return inside.size > 1 and inside[0] <= start and inside[-1] >= end and float(np.diff(inside).max()) <= gap


def biases(judged: Judged, count: int, metres: Sequence[float] = BIASES_M) -> list[Row]:
    """A position offset of so many metres in a random direction: detected within 5 s by the test of one sample?"""
    columns, branches = judged.filter.columns, judged.model.monitor.branches
    largest = Whitened((columns.position, columns.velocity), len(judged.rest.channels), joint=False)
    second = Branch(largest, Fixed(jnp.full(2, jnp.inf)), subject=MOTION)
    both = replace(judged.model.monitor, branches=(*branches, second))
    healthy = judged.learn.time > judged.learn.time[0] + 10.0
    tape = open_loop_scores(both, judged.learn)[-1][healthy]
    limits = [float(np.asarray(branches[0].threshold.limit)[0])]  # type: ignore[attr-defined]
    limits.append(float(gumbel_limit(tape, judged.learn.time[healthy], 0.25, 5.0)[0]))
    starts = onsets(judged, count, WITHIN_S)
    random = np.random.default_rng(0)
    rest, (latitude, longitude) = judged.rest, judged.filter.columns.position
    clean = [np.asarray(replay_log(both, rest).scores[k])[:, 0] for k in (0, -1)]
    rows = []

    def row(name: str, fault: str | None, size: float | None, metric: str, value: float, seeds: int = 1) -> None:
        source = "injected" if fault else "real"
        rows.append(
            Row("A3", judged.data, source, f"{name} instant", "bicycle-kalman", fault, size, metric, value, None, seeds)
        )

    for name, limit, score in zip(NORMS, limits, clean, strict=True):
        tested = np.isfinite(score)
        row(name, None, None, "far", float((score[tested] > limit).mean()))
        chance = [_first(score, rest.time, start, limit) is not None for start in starts]
        row(name, None, None, "chance", float(np.mean(chance)))
        row(name, None, None, "limit", limit)
    # the time at which the fix in a row was measured
    of_fix = rest.time[np.maximum.accumulate(np.where(rest.fresh[:, latitude], np.arange(len(rest)), 0))]
    for size in metres:
        found: list[list[float | None]] = [[], []]
        for start in starts:
            angle = random.uniform(0, 2 * np.pi)
            value = rest.value.copy()
            fixed = of_fix >= start
            value[fixed, latitude] += size * np.sin(angle) / SEMI_MAJOR_AXIS
            value[fixed, longitude] += size * np.cos(angle) / SEMI_MAJOR_AXIS / np.cos(value[fixed, latitude])
            scores = replay_log(both, replace(rest, value=value)).scores
            for k, (branch, limit) in enumerate(zip((0, -1), limits, strict=True)):
                found[k].append(_first(np.asarray(scores[branch])[:, 0], rest.time, start, limit))
        for name, delays in zip(NORMS, found, strict=True):
            hit = [d for d in delays if d is not None]
            row(name, "offset", size, "detection_rate", len(hit) / max(len(delays), 1), len(delays))
            if hit:
                row(name, "offset", size, "delay_s", float(np.mean(hit)), len(hit))
    return rows


def _first(score: Float[np.ndarray, " T"], time: Float[np.ndarray, " T"], start: float, limit: float) -> float | None:
    """Delay of the first alarm within 5 s of the onset."""
    over = np.flatnonzero((time >= start) & (time < start + WITHIN_S) & (np.nan_to_num(score) > limit))
    return float(time[over[0]] - start) if over.size else None


def motions(judged: Judged, rivals: Sequence[Model], count: int) -> list[Row]:
    """Motions that no bicycle makes: share reported as motion, and share with a sensor named."""
    wanted = WHEELED if judged.felt.wheels else TURNED
    models = (judged.model, *rivals)
    clean = [detect(model, judged.rest).events for model in models]
    rows = []
    for kind, length_s, size in wanted:
        starts = onsets(judged, count, length_s, LEAST_SPEED)
        counted = np.zeros((len(models), 4))  # reported as motion, a sensor named, and both without the fault
        for k, start in enumerate(starts):
            fault = MotionFault(kind, start, length_s, size if k % 2 or kind == "wheel slip" else -size)
            log = move(judged.rest, fault, judged.felt)
            for m, model in enumerate(models):
                for at, events in ((0, detect(model, log).events), (2, clean[m])):
                    here = [e for e in events if e.start_s <= fault.end_s + AFTER_S and (e.end_s or np.inf) >= start]
                    counted[m, at] += any(e.subject == "motion" for e in here)
                    counted[m, at + 1] += any(e.subject == "sensor" and e.kind != "missing" for e in here)
        name = f"{kind} {length_s:g}s".replace(" ", "-")
        many = len(starts)
        for model, counts in zip(models, counted, strict=True):
            for metric, c in zip(("detection_rate", "wrong_exclusions", "chance", "chance_wrong"), counts, strict=True):
                share = float(c) / max(many, 1)
                rows.append(
                    Row("A3", judged.data, "injected", "motion", model.method, name, size, metric, share, None, many)
                )
    return rows
