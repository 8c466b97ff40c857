"""The experiment on the real arm: detection and isolation of each method at a common false alarm rate."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault.simulation.arm import channels
from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort
from sensorfault_studies.niu1998.fleet import Result, watch, with_limits
from sensorfault_studies.niu1998.isolation import (
    GROUPS,
    SENSORS,
    Calibrated,
    Runs,
    Trial,
    isolated,
    missed,
    one_step_error,
    stretches,
    trials,
)
from sensorfault_studies.niu1998.rivals import NETWORK, Rival, of_six_joints
from sensorfault_studies.niu1998.run import joined
from sensorfault_studies.niu1998.schunk import ARCHIVE, JOINTS, PERIOD_S, runs
from sensorfault_studies.numbers import Numbers

DATA = "schunk"
EACH, QUICK_EACH = 8, 3  # faults of every kind and size on every sensor, for each seed
PATHS = tuple(channel.path for channel in channels(JOINTS)[:SENSORS])
APART = PATHS[:JOINTS], PATHS[JOINTS:]  # rates are predicted without angles, and angles without rates
SINGLE = ("spike", "offset", "frozen")  # the kinds for which isolation is measured
NEW = "new-motion"
TIMED = ("frozen", "delay", "missing")
SHOWN, ALL = "far1e-2", "all"


@dataclass
class Joints:
    """Numbers of all methods; sensors isolated by the network, for faults of five one-step errors on each sensor."""

    injected: Numbers = field(default_factory=lambda: Numbers("B", DATA, "injected"))
    real: Numbers = field(default_factory=lambda: Numbers("B", DATA, "real"))
    accused: Int[np.ndarray, "12 13"] = field(default_factory=lambda: np.zeros((SENSORS, SENSORS + 1), int))


def joints(effort: Effort) -> Joints:
    """All methods on the same faults; then on a motion that none of them was trained on.

    Raises:
        LogError: the runs do not exist.
    """
    result = Joints()
    logs = runs(real("arm") / ARCHIVE)
    splits = [("", Runs.of(logs, seed)) for seed in range(1 if effort.quick else effort.seeds)]
    splits.append((NEW, Runs.of_another_motion(logs)))
    for seed, (words, parts) in enumerate(splits):
        effort.progress(f"the real arm {words}".strip(), seed / len(splits))
        _judge(result, words, parts, seed, effort.quick)
    return result


def _judge(result: Joints, split: str, parts: Runs, seed: int, quick: bool) -> None:
    other, judged = stretches(parts.other), stretches(parts.judged)
    faults: list[Trial] = []
    first, *others = of_six_joints(APART)
    for rival in (first, *others):
        words = f"{split} {rival.variant}".strip()
        own = Calibrated.of(rival.build(joined(parts.learned), seed), other)
        if rival == first:
            faults = trials(judged, own.unit, QUICK_EACH if quick else EACH, seed, quick or split == NEW)
        _quiet(result, words, rival, own, judged)
        for rate, limit in own.limits.items():
            condition = f"{rate} {words}".strip()
            _isolate(result, condition, rival, with_limits(own.uncalibrated, limit), faults, judged)


def _quiet(result: Joints, words: str, rival: Rival, own: Calibrated, healthy: Sequence[Log]) -> None:
    """Median one-step errors over six sensors; and how often a score exceeds its limit in healthy runs."""
    seen = watch(own.uncalibrated, healthy)
    score, error = seen.score, one_step_error(seen)
    for group in ("tachometers", "encoders"):
        result.real.add(f"{group} {words}".strip(), rival.method, {"rms": float(np.median(error[GROUPS[group]]))})
    for rate, limit in own.limits.items():
        far = float((np.nan_to_num(score) > limit).any(axis=2).mean())
        result.real.add(f"{rate} {words}".strip(), rival.method, {"far": far})


def _isolate(
    result: Joints, words: str, rival: Rival, model: Model, faults: Sequence[Trial], healthy: Sequence[Log]
) -> None:
    """Correct isolation for every kind and size over stretches without an earlier alarm, and the rate by chance."""
    quiet = watch(model, healthy)
    far, calm = quiet.fault.any(axis=2).mean(), isolated(quiet, np.zeros(len(healthy), int)).calm.mean()
    result.real.add(f"{words} as-run", rival.method, {"far": float(far), "calm": float(calm)})
    chance = np.array([_chance(quiet, column) for column in range(SENSORS)])
    seen = watch(model, [trial.log for trial in faults])
    column = np.array([trial.column for trial in faults])
    outcome, missing = isolated(seen, column), missed(seen, column)
    kinds = [(trial.kind, trial.size) for trial in faults]
    five = np.array([kind in SINGLE and (kind == "frozen" or size == 5.0) for kind, size in kinds]) & outcome.calm
    pooled = {"detection_rate": _mean(outcome.right[five])}
    result.injected.add(f"{words} {ALL}", rival.method, pooled, " or ".join(SINGLE))
    for kind, size in dict.fromkeys(kinds):
        mine = np.array([one == (kind, size) for one in kinds]) & outcome.calm
        for group, part in (GROUPS if words == SHOWN else {ALL: GROUPS[ALL]}).items():
            rows = mine & np.isin(column, np.arange(SENSORS)[part])
            if kind == "missing":
                numbers = {"detection_rate": _mean(missing[rows])}
            else:
                numbers = {"detection_rate": _mean(outcome.right[rows]), "chance": float(chance[part].mean())}
                numbers["delay_steps"] = _median(outcome.delay[rows & outcome.right])
            result.injected.add(f"{words} {group}", rival.method, numbers, kind, _size(kind, size))
    if rival.method == NETWORK and words == SHOWN:
        for i in np.flatnonzero(five):
            result.accused[column[i], :SENSORS] += outcome.named[i]
            result.accused[column[i], SENSORS] += not outcome.named[i].any()


def _chance(quiet: Result, column: int) -> float:
    """How often a healthy stretch counts as correct isolation of this sensor."""
    outcome = isolated(quiet, np.full(len(quiet.channel), column))
    return _mean(outcome.right[outcome.calm])


def _median(delay: Float[np.ndarray, " N"]) -> float:
    return float(np.median(delay)) if delay.size else float("nan")


def _mean(right: Bool[np.ndarray, " N"]) -> float:
    return float(right.mean()) if right.size else float("nan")


def _size(kind: str, size: float) -> float:
    """In seconds where OTHERS counts ticks."""
    return size * PERIOD_S if kind in TIMED else size
