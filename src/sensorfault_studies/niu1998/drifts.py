"""Two drifts at once, with the paper's thresholds and at a common false alarm rate; then slower single drifts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from sensorfault.runtime.model import Model
from sensorfault.simulation.arm import AS_PRINTED, PHYSICAL
from sensorfault_studies.findings import Effort, Row
from sensorfault_studies.niu1998.fleet import Result, watch, with_limits
from sensorfault_studies.niu1998.rivals import KALMAN, Rival, of_two_links
from sensorfault_studies.niu1998.run import (
    COLUMNS,
    JUDGED,
    ONSET,
    SENSORS,
    WITHIN,
    Watched,
    early,
    first,
    found_soon,
    increment_error,
    theta,
)
from sensorfault_studies.numbers import Numbers

SETTINGS = {"as-printed": AS_PRINTED, "physical": PHYSICAL}
ELSEWHERE = replace(AS_PRINTED, start=(11.0, -8.2, 0.8, 1.9))
FROM_REST = replace(AS_PRINTED, start=(0.0, 0.0, 0.0, 0.0))
AT_RATE = "far5e-2"
FAST = 2.0  # drift rate in thresholds a sample
SLOWER = (2.0, 1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02)
QUICK = (2.0, 0.5, 0.1)
FOUND = 0.95  # share of runs in which a drift rate must be detected to count as detectable
PAPER = {"sample_y2": 51.0, "sample_y4": 51.0, "theta_y2": 0.024, "theta_y4": 0.0182}
NAMES = ("y2", "y4")


@dataclass
class Drifts:
    """Numbers of all methods, and the output of the first network of the first seed for the paper's run."""

    numbers: Numbers = field(default_factory=lambda: Numbers("B", "arm", "simulated"))
    shown: dict[str, tuple[Result, Float[np.ndarray, "N T C"]]] = field(default_factory=dict)

    def rows(self) -> Iterator[Row]:
        """Rows; the paper's samples and thresholds are added to those for its printed setting."""
        for row in self.numbers.rows():
            paper = PAPER.get(row.metric) if row.condition.split()[0] == "as-printed" and row.fault else None
            yield replace(row, paper=paper)


def drifts(effort: Effort) -> Drifts:
    """Every method on both arms; the sweep and the start from rest only with the printed arm."""
    result = Drifts()
    seeds = 1 if effort.quick else effort.seeds
    done = 0
    for name, setting in SETTINGS.items():
        rivals = of_two_links(setting.constants, _by_path(theta(setting)))
        for rival in rivals:
            for seed in range(seeds):
                effort.progress(
                    f"{rival.method} on the paper's arm, {name}", done / (len(SETTINGS) * len(rivals) * seeds)
                )
                watched = Watched.of(rival, setting, seed)
                limited = watched.at_rate()
                _judge(result, name, rival, watched, limited)
                if setting is AS_PRINTED:
                    _elsewhere(result.numbers, name, rival, watched, limited)
                    _sweep(result.numbers, name, rival, watched, limited, QUICK if effort.quick else SLOWER)
                    _from_rest(result.numbers, rival, seed)
                done += 1
    return result


def _by_path(limit: Float[np.ndarray, " C"]) -> Mapping[str, float]:
    paths = ("tachometer1.rate", "tachometer2.rate", "encoder1.angle", "encoder2.angle")
    return dict(zip(paths, limit[list(JUDGED)].tolist(), strict=True))


def _judge(result: Drifts, name: str, rival: Rival, watched: Watched, limited: Model) -> None:
    """Both drifts of two thresholds a sample, with the paper's thresholds and at the common false alarm rate."""
    limit = theta(watched.setting)
    printed = watched.model if rival.method == KALMAN else with_limits(watched.model, limit)
    fast = {sensor: FAST * float(limit[column]) for sensor, column in zip(SENSORS, COLUMNS, strict=True)}
    condition = f"{name} {rival.variant}".strip()
    drifting = watched.drifting(fast)
    for words, model in ((condition, printed), (f"{condition} {AT_RATE}", limited)):
        seen = watch(model, drifting)
        numbers = {"detection_rate": found_soon(seen).mean(), "far": early(seen).mean()}
        numbers |= {f"sample_{y}": first(seen, column).mean() for y, column in zip(NAMES, COLUMNS, strict=True)}
        numbers["untested"] = 1 - seen.tested[:, :ONSET, JUDGED].mean()
        if rival.method != KALMAN:
            numbers |= {f"theta_{y}": seen.limit[column] for y, column in zip(NAMES, COLUMNS, strict=True)}
        result.numbers.add(words, rival.method, numbers, "drift")
        result.shown.setdefault(f"{words} {rival.method}", (seen, np.stack([log.value for log in drifting])))
    _errors(result.numbers, condition, rival, watched)


def _errors(numbers: Numbers, condition: str, rival: Rival, watched: Watched) -> None:
    """One-step errors of both joint rates and of y2 alone in healthy runs, with and without the sensors' noise."""
    runs = {condition: watched.healthy(), f"{condition} noise-free": watched.healthy(0.0)}
    for words, logs in runs.items():
        seen = watch(watched.uncalibrated, logs)
        errors = {"rms": increment_error(seen), "rms_y2": increment_error(seen, (COLUMNS[0],))}
        numbers.add(words, rival.method, errors)


def _elsewhere(numbers: Numbers, name: str, rival: Rival, watched: Watched, limited: Model) -> None:
    """The same arm, model and limits with another motion: share of healthy runs with an early alarm."""
    moved = replace(watched, setting=ELSEWHERE)
    condition = " ".join(part for part in (name, rival.variant, AT_RATE, "other-start") if part)
    numbers.add(condition, rival.method, {"far": early(watch(limited, moved.healthy())).mean()})


def _from_rest(numbers: Numbers, rival: Rival, seed: int) -> None:
    if rival.method != KALMAN:
        _errors(numbers, f"as-printed from-rest {rival.variant}".strip(), rival, Watched.of(rival, FROM_REST, seed))


def _sweep(numbers: Numbers, name: str, rival: Rival, watched: Watched, model: Model, rates: tuple[float, ...]) -> None:
    """One sensor drifts at lower and lower rates: detected within WITHIN samples, at the common false alarm rate."""
    limit = theta(watched.setting)
    for y, sensor, column in zip(NAMES, SENSORS, COLUMNS, strict=True):
        condition = " ".join(part for part in (name, rival.variant, AT_RATE, y) if part)
        for rate in rates:
            share = _soon(model, watched, {sensor: rate * float(limit[column])}, column)
            numbers.add(condition, rival.method, {"detection_rate": share}, "drift", rate)
        chance = _soon(model, watched, {}, column)
        for rate in rates:
            numbers.add(condition, rival.method, {"chance": chance}, "drift", rate)


def _soon(model: Model, watched: Watched, rate: Mapping[str, float], column: int) -> float:
    """Share of the runs with an alarm on this sensor in the samples after the onset."""
    fault = watch(model, watched.drifting(rate)).fault[:, ONSET + 1 : ONSET + 1 + WITHIN, column]
    return float(fault.any(axis=1).mean())


def smallest(numbers: Numbers, condition: str, method: str, rates: tuple[float, ...]) -> float:
    """The smallest drift such that it and all faster ones are detected in FOUND of the runs; NaN if there is none."""
    found = float("nan")
    for rate in sorted(rates, reverse=True):
        if not numbers.mean(condition, method, "detection_rate", "drift", rate) >= FOUND:
            break
        found = rate
    return found
