"""Experiment C, condition (a): a real drive with simulated satellites, one of which is faulty."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sensorfault.core.monitor import Monitor
from sensorfault.simulation.pseudorange import Noise
from sensorfault_studies.findings import Effort
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.campaign import SETTLED, Case, case, false_alarms, flown
from sensorfault_studies.wang2023.contenders import (
    ALONE,
    CHI_SQUARE,
    LOF,
    NONE,
    OURS,
    Contender,
    contenders,
    without_exclusion,
)
from sensorfault_studies.wang2023.drive import pseudoranges
from sensorfault_studies.wang2023.matching import matched
from sensorfault_studies.wang2023.trials import FAULTS, SatelliteFault, outcome, trials

EXPERIMENT, DATA = "C", "drive0708"
RATE = 1e-2  # false alarm rate of an epoch
PRINTED, EQUAL = "as-printed", "far1e-2"
# Seeds of the errors: test with a fault, test without, calibration, training. None was used during development.
JUDGED, FREE, CALIBRATED, LEARNED = 41_000, 42_000, 43_000, 44_000
CHIEF = (NONE, CHI_SQUARE, "aime-10", LOF, ALONE, OURS)
MAIN = tuple(
    SatelliteFault(kind, size) for kind, size in (("step", 10.0), ("step", 15.0), ("ramp", 0.25), ("ramp", 0.5))
)


@dataclass(frozen=True)
class Condition:
    """A condition of the experiment. `factor`: of the pseudorange standard deviation in the filter; `faults`: those
    tested, for these `methods` or for all.
    """

    words: str
    noise: Noise
    rates: bool
    factor: float
    faults: Sequence[SatelliteFault]
    methods: Sequence[str] = ()


HEAVY = Condition("heavy pseudorange R1", "heavy", False, 1.0, FAULTS)
INFLATED = Condition("heavy pseudorange R2", "heavy", False, 2.0, MAIN, CHIEF)
CONDITIONS = (
    HEAVY,
    INFLATED,
    Condition("gaussian pseudorange R1", "gaussian", False, 1.0, MAIN, CHIEF),
    Condition("heavy range-rate R1", "heavy", True, 1.0, MAIN, CHIEF),
)


@dataclass(frozen=True)
class Runs:
    """Number of runs for each purpose."""

    judged: int
    free: int
    calibrated: int
    learned: int


FULL, QUICK = Runs(3, 60, 120, 24), Runs(1, 12, 24, 12)


def judged(condition: Condition, numbers: Numbers, effort: Effort) -> None:
    """All methods, with published limits and at a common false alarm rate."""
    runs = QUICK if effort.quick else FULL
    of = case(condition.rates)
    learned, calibration, free, errors = (
        pseudoranges(condition.noise, range(first, first + many))
        for first, many in (
            (LEARNED, runs.learned),
            (CALIBRATED, runs.calibrated),
            (FREE, runs.free),
            (JUDGED, runs.judged),
        )
    )
    every = [
        one
        for one in contenders(of, learned, condition.factor)
        if one.name in condition.methods or not condition.methods
    ]
    run_of = flown(without_exclusion(of, condition.factor), of, free)
    settled = run_of.normalised[:, SETTLED:, : len(of.framing.satellites)]
    for run, off in zip(settled, run_of.off_m[:, SETTLED:], strict=True):
        rmse = float(np.sqrt(np.mean(off**2)))
        numbers.add(condition.words, NONE, {"innovation_sd": float(np.nanstd(run)), "healthy_hrmse_m": rmse})
    faults = condition.faults[1:3] if effort.quick else condition.faults
    for k, one in enumerate(every):
        effort.progress(f"{condition.words}: {one.name}", k / len(every))
        for words, monitor in _variants(one, of, calibration, condition, numbers):
            healthy = flown(monitor, of, free)
            if one.name != NONE:
                numbers.add(words, one.name, {"far": false_alarms(healthy)})
            for fault in faults:
                for row in outcome(flown(monitor, of, trials(errors, fault)), len(errors)):
                    kept = row if one.name != NONE else {"hrmse_m": row["hrmse_m"]}
                    numbers.add(words, one.name, kept, fault.kind, fault.size)


def _variants(
    one: Contender, of: Case, calibration: np.ndarray, condition: Condition, numbers: Numbers
) -> list[tuple[str, Monitor]]:
    if one.printed is None and one.free is None:
        return [(f"{condition.words} {EQUAL}", without_exclusion(of, condition.factor))]
    found = [] if one.printed is None else [(f"{condition.words} {PRINTED}", one.printed)]
    if one.free is not None:
        words = f"{condition.words} {EQUAL}"
        monitor, limit, reached = matched(one.free, of, calibration, RATE)
        limits = {"limit": limit.limit, "limit_low": limit.low, "limit_high": limit.high, "far_calibrated": reached}
        numbers.add(words, one.name, limits)
        found.append((words, monitor))
    return found
