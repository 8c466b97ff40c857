"""The mission of Xu et al. 2023: the faulty ranges, and the error of each range."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.simulation.acoustic import Ranging
from sensorfault.simulation.underwater import Mission, sail

DURATION_S, TRAINED_S = 1700.0, 600.0
WRONG_M = 9.0  # T1: a range with a larger error is an anomaly [m]
ANOMALIES = (51, 6)  # of each leader, in the test part
PRINTED = (
    Fault("frozen", "leader1", "range", 100.0, 50.0),
    Fault("frozen", "leader2", "range", 400.0, 50.0),
    Fault("drift", "leader1", "range", 1100.0, 70.0, 0.5),
)
LONGEST_S = 60.0  # longest frozen fault that is added to reach this number [s]
RANGING = Ranging(lost=0.015)
FAST = replace(RANGING, sigma_m=1.0, period_s=2.35)


@dataclass(frozen=True)
class Scenario:
    """A log of ranges with known errors.

    `error`: of each range, L leaders, as GPS would show it [m]; NaN where there is no range. `position`: true, latitude
    and longitude [rad], or north and east [m] if not `geodetic`. `wrong_m`: a range with a larger error is an anomaly,
    one number or one for each leader. The training part ends at `since_s`; the rest is the test part.
    """

    log: Log
    error: Float[np.ndarray, "T L"]
    position: Float[np.ndarray, "T 2"]
    faults: tuple[Fault, ...] = ()
    wrong_m: float | Float[np.ndarray, " L"] = WRONG_M
    since_s: float = TRAINED_S
    geodetic: bool = True

    @property
    def wrong(self) -> Bool[np.ndarray, "T L"]:
        """The anomalous ranges."""
        return np.asarray(np.abs(self.error) > self.wrong_m)

    @property
    def judged(self) -> Bool[np.ndarray, " T"]:
        """The rows of the test part."""
        return np.asarray(self.log.time >= self.since_s)


def scenario(seed: int, ranging: Ranging = RANGING) -> Scenario:
    """A simulated mission with the paper's faults."""
    return struck(sail(DURATION_S, seed, ranging), seed)


def struck(mission: Mission, seed: int, wrong_m: float = WRONG_M) -> Scenario:
    """The mission with the published faults, and random frozen faults of a leader until it has as many wrong ranges as
    published, or as close as possible.
    """
    rng = np.random.default_rng([seed, 2023])
    faults = list(PRINTED)
    for j, wanted in enumerate(ANOMALIES):
        for _ in range(400):
            missing = wanted - _count(mission, faults, j, wrong_m)
            if missing <= 0:
                break
            start, longest = rng.uniform(TRAINED_S, DURATION_S - LONGEST_S), rng.uniform(20.0, LONGEST_S)
            if _free(faults, f"leader{j + 1}", start, longest):
                faults += _freeze(mission, faults, j, (start, longest), missing, wrong_m)
    done = inject(mission.log, faults, seed)
    return Scenario(done.log, error(done.log, mission.truth), mission.truth.value[:, :2], done.truth)


def error(log: Log, truth: Log) -> Float[np.ndarray, "T L"]:
    """Error of each range [m], NaN where there is none."""
    columns = [i for i, channel in enumerate(log.channels) if channel.name == "range"]
    result = np.where(log.fresh[:, columns], log.value[:, columns], np.nan)
    return np.asarray(result - truth.value[:, columns])


def _count(mission: Mission, faults: list[Fault], j: int, wrong_m: float) -> int:
    off = error(inject(mission.log, faults).log, mission.truth)[mission.log.time >= TRAINED_S, j]
    return int((np.abs(off) > wrong_m).sum())


def _free(faults: list[Fault], sensor: str, start: float, length: float) -> bool:
    """Whether that leader has no other fault from some time before until some time after."""
    return all(f.sensor != sensor or start > f.end_s + 10 or start + length < f.start_s - 10 for f in faults)


def _freeze(
    mission: Mission, faults: list[Fault], j: int, when: tuple[float, float], missing: int, wrong_m: float
) -> list[Fault]:
    """A frozen fault that makes wrong ranges, but no more than are missing; empty if there is none."""
    before = _count(mission, faults, j, wrong_m)
    for length in np.arange(when[1], 10.0, -2.5):
        frozen = Fault("frozen", f"leader{j + 1}", "range", when[0], float(length))
        more = _count(mission, [*faults, frozen], j, wrong_m) - before
        if more <= missing:
            return [frozen] if more > 0 else []
    return []
