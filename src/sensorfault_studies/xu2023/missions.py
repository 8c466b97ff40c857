"""Every method on every mission, for all conditions of the study."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.simulation.underwater import sail
from sensorfault_studies.findings import Effort
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023 import real_auv
from sensorfault_studies.xu2023.contenders import AGAINST, RIVAL, Contender, contenders, eased
from sensorfault_studies.xu2023.run import Flown, lockout_s, scores, table, through
from sensorfault_studies.xu2023.scenario import FAST, RANGING, Scenario, error, scenario

EXPERIMENT = "E"
MISSIONS, FEW = 24, 4  # test missions; with --quick
FIRST, POOL, POOLED = 1000, 300, 8  # first seed of the test missions; first seed and number of the training missions
MATCHED = 0.02  # false alarm rate on the pooled missions, for the comparison at a common rate
STEPS = np.geomspace(0.5, 4.0, 19)  # factors of the limits that are tried for it
FROZEN_S = (800.0, 200.0)  # start and length of the fault of both leaders in the test of recovery [s]


@dataclass(frozen=True)
class Condition:
    """Missions of one kind, and the noise that the filters assume."""

    words: str
    data: str
    source: str
    make: Callable[[int], Scenario]
    q: float
    sigma_m: float


CONDITIONS = (
    Condition("Q0.2", "simulated", "simulated", scenario, 0.2, 3.0),
    Condition("Q1", "simulated", "simulated", scenario, 1.0, 3.0),
    Condition("fast", "simulated", "simulated", lambda seed: scenario(seed, FAST), 0.2, 1.0),
    Condition("Q0.2", "snapir", "injected", real_auv.scenario, 0.2, 3.0),
)


@dataclass(frozen=True)
class Result:
    """The numbers of one condition; `shown`: each method's run of the first mission, with published limits."""

    condition: Condition
    numbers: Numbers
    case: Scenario
    shown: dict[str, Flown]
    off_m: dict[str, Float[np.ndarray, " N"]]
    accuracy: dict[str, Float[np.ndarray, " S"]]


def judged(condition: Condition, effort: Effort) -> Result:
    """All methods, with their own limits and with limits for a common false alarm rate."""
    many = FEW if effort.quick else max(MISSIONS, effort.seeds)
    pool = [condition.make(POOL + k) for k in range(POOLED)]
    cases = [condition.make(FIRST + k) for k in range(many)]
    frozen = [] if condition.data != "simulated" else [_both_frozen(FIRST + k) for k in range(many)]
    result = Numbers(EXPERIMENT, condition.data, condition.source)
    shown: dict[str, Flown] = {}
    off_m: dict[str, Float[np.ndarray, " N"]] = {}
    accuracy: dict[str, Float[np.ndarray, " S"]] = {}
    every = contenders(condition.q, condition.sigma_m, pool)
    for k, one in enumerate(every):
        name = f"{one.name} {one.words}".strip()
        words = f"{condition.words} {one.words}".strip()
        effort.progress(f"{condition.data} {condition.words}: {name}", k / len(every))
        flown = [through(one.make(case), case) for case in cases]
        tables = np.array([table(run.flagged, case) for run, case in zip(flown, cases, strict=True)])
        gated = one.name != "ungated-ackf"
        for run, case, four in zip(flown, cases, tables, strict=True):
            result.add(f"{words} as-printed", one.name, scores(four, run.off_m[case.judged], gated))
        shown[name] = flown[0]
        off_m[name] = np.concatenate([run.off_m[case.judged] for run, case in zip(flown, cases, strict=True)])
        accuracy[name] = tables[:, :2].sum(axis=1) / tables.sum(axis=1)
        if not gated:
            continue
        for case in frozen if condition.words == "Q0.2" else []:
            run = through(one.make(case), case)
            result.add(f"{words} both-frozen", one.name, {"lockout_s": lockout_s(run.flagged, case, sum(FROZEN_S))})
        times = _matched(one, pool)
        if np.isfinite(times):
            for case in cases:
                run = through(eased(one.make(case), times), case)
                result.add(f"{words} fpr2e-2", one.name, scores(table(run.flagged, case), run.off_m[case.judged]))
    for name, values in accuracy.items():
        method, _, variant = name.partition(" ")
        for rival in (AGAINST, RIVAL):
            words = f"{condition.words} {variant}".strip() + f" against {rival}"
            for win in values > accuracy[rival]:
                result.add(words, method, {"paired_wins": float(win)})
    return Result(condition, result, cases[0], shown, off_m, accuracy)


def _matched(one: Contender, pool: Sequence[Scenario]) -> float:
    """The smallest factor of the limit that keeps the false alarm rate of the pooled missions below MATCHED."""
    monitors = [one.make(case) for case in pool]
    for times in STEPS:
        runs = [through(eased(m, times), case) for m, case in zip(monitors, pool, strict=True)]
        _, tn, fp, _ = np.sum([table(run.flagged, case) for run, case in zip(runs, pool, strict=True)], axis=0)
        if fp <= MATCHED * (tn + fp):
            return float(times)
    return float("nan")


def _both_frozen(seed: int) -> Scenario:
    """A healthy mission except that both leaders freeze for a long time."""
    mission = sail(1700.0, seed, replace(RANGING))
    done = inject(mission.log, [Fault("frozen", f"leader{j}", "range", *FROZEN_S) for j in (1, 2)], seed)
    return Scenario(done.log, error(done.log, mission.truth), mission.truth.value[:, :2], done.truth)
