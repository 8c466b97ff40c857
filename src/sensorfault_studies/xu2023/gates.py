"""The gates for real ranges, each with the noise fitted on the first part of the log, and their comparison."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.chi_square_cubature import gate, limit
from sensorfault.methods.ranging.cooperative import REPEATED, gates
from sensorfault.methods.ranging.range_filter import GROWTH, Filter, cubature, fitted, followed, monitor
from sensorfault.stages.residual.cubature import Cubature
from sensorfault.vehicles.underwater import FollowerRoles
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023.contenders import eased
from sensorfault_studies.xu2023.run import Flown, scores, table, through
from sensorfault_studies.xu2023.scenario import Scenario

FITTED, MATCHED, ALL = "as-fitted", "fpr5e-3", "all"
RATE = 0.005  # of healthy ranges, for the comparison at a common false alarm rate
OFF = 1e9  # factor that raises a limit beyond every score


@dataclass(frozen=True)
class Watched:
    """One log and its monitors by method; `name` is part of the condition."""

    name: str
    case: Scenario
    monitors: Mapping[str, Monitor]


def early(case: Scenario) -> Log:
    """The training part of the log."""
    return case.log.between(end_s=case.since_s)


def following(name: str, case: Scenario) -> Watched:
    """A follower among beacons."""
    log = early(case)
    found = followed("xu2023", log)
    own = fitted(log, found, Filter())
    return Watched(name, case, watching(log, found, own, lambda filter: cubature(log, found, filter)))


def watching(log: Log, found: FollowerRoles, own: Filter, residual: Callable[[Filter], Cubature]) -> dict[str, Monitor]:
    """No gate, χ² at 0.01 and `cooperative`, on filters with this noise, fitted on this log."""
    plain, adaptive = (residual(replace(own, adaptive=kind)) for kind in (False, True))
    return {
        "ungated-ckf": monitor(log, plain),
        "ungated-ackf": monitor(log, adaptive),
        "chi-square-ckf-01": gate(log, found, plain, 0.01),
        "chi-square-ackf-01": gate(log, found, adaptive, 0.01),
        "cooperative": gates(log, found, residual(replace(own, growth=GROWTH, repeated=REPEATED)))[0],
    }


def normalised(run: Flown, case: Scenario) -> Float[np.ndarray, "T L"]:
    """Size of each range's innovation divided by the filter's standard deviation; NaN where there is no range."""
    ranges = [i for i, channel in enumerate(case.log.channels) if channel.name == "range"]
    s = np.diagonal(run.residual.cov, axis1=1, axis2=2)[:, ranges]
    return np.where(np.isnan(case.error), np.nan, np.abs(run.residual.value[:, ranges]) / np.sqrt(s))


def innovation_sd(run: Flown, case: Scenario) -> float:
    """Robust standard deviation of the normalised innovations in the test part; 1 if the filter is consistent."""
    return 1.4826 * float(np.nanmedian(normalised(run, case)[case.judged]))


def matching(method: str, all_of: Sequence[Watched], rows: int) -> float:
    """The factor of the limit that RATE of the healthy ranges of the training parts exceed in open loop."""
    seen = []
    for one in all_of:
        run = through(eased(one.monitors[method], OFF), one.case, rows)
        seen.append(normalised(run, one.case)[~one.case.judged[:, None] & ~one.case.wrong])
    return float(np.nanquantile(np.concatenate(seen), 1 - RATE)) / limit(0.01)


def compared(numbers: Numbers, words: str, all_of: Sequence[Watched], times: Mapping[str, float], rows: int) -> None:
    """Numbers of each log and of all logs, with the limits of these methods multiplied by these factors."""
    for method, factor in times.items():
        gated = not method.startswith("ungated")
        runs = [through(eased(one.monitors[method], factor), one.case, rows) for one in all_of]
        tables = [table(run.flagged, one.case) for run, one in zip(runs, all_of, strict=True)]
        off_m = [run.off_m[one.case.judged] for run, one in zip(runs, all_of, strict=True)]
        for one, run, four, off in zip(all_of, runs, tables, off_m, strict=True):
            measured = scores(four, off, gated) | {"innovation_sd": innovation_sd(run, one.case)}
            numbers.add(f"{one.name} {words}", method, measured)
        numbers.add(f"{ALL} {words}", method, scores(np.sum(tables, axis=0), np.concatenate(off_m), gated))
        for kind in {fault.kind: 0 for one in all_of for fault in one.case.faults} if gated else ():
            faulty = [run.flagged[_faulty(one.case, kind)] for run, one in zip(runs, all_of, strict=True)]
            numbers.add(f"{ALL} {words}", method, {"recall": float(np.concatenate(faulty).mean())}, kind)


def _faulty(case: Scenario, kind: str) -> Bool[np.ndarray, "T L"]:
    """The ranges that a fault of this kind has made wrong."""
    sensors = [channel.sensor for channel in case.log.channels if channel.name == "range"]
    during = np.zeros(case.error.shape, bool)
    for fault in case.faults:
        if fault.kind == kind:
            rows = (case.log.time >= fault.start_s) & (case.log.time < fault.end_s)
            during[rows, sensors.index(fault.sensor)] = True
    return np.asarray(during & case.wrong)
