"""The paper's run: two sensors that drift from sample 50 on, seen by one method under its limits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault.simulation.arm import PERIOD_S, SAMPLES, VARIANCE, Setting, motion, run
from sensorfault_studies.niu1998.fleet import Result, watch, with_limits
from sensorfault_studies.niu1998.rivals import Rival

ONSET = 50
SOON = (51, 52)  # the paper finds both at 51
WITHIN = 10  # samples
SENSORS = ("tachometer2", "encoder2")  # y2, y4
COLUMNS = (1, 3)
RATES = (0, 1)
JUDGED = (0, 1, 2, 3)
FAR = 0.05  # share of runs with an alarm before the onset
RUNS = 40  # noise seeds to be judged for each seed of the study
CALIBRATED = 400  # other runs, to set limits on
LEARN = 30  # healthy runs to fit on
PAUSE_S = 1.0  # of the clock between two runs that are joined
LEARNED, OTHERS = 1_000_000, 500_000  # their seeds are far from the judged ones'


@dataclass(frozen=True)
class Watched:
    """A rival's model of one seed, and what its judged runs are."""

    setting: Setting
    model: Model
    seeds: range

    @classmethod
    def of(cls, rival: Rival, setting: Setting, seed: int) -> "Watched":
        """Fitted on runs of its own."""
        learned = joined([_run(setting, LEARNED + LEARN * seed + i) for i in range(LEARN)])
        return cls(setting, rival.build(learned, seed), range(RUNS * seed, RUNS * (seed + 1)))

    @property
    def uncalibrated(self) -> Model:
        """With its limits off."""
        return with_limits(self.model, np.full(len(self.model.channels), np.inf))

    def healthy(self, variance: float = VARIANCE) -> list[Log]:
        """The judged runs before anything lies."""
        return [_run(self.setting, seed, variance) for seed in self.seeds]

    def drifting(self, rate: Mapping[str, float]) -> list[Log]:
        """The judged runs with drifts [SI a sample] on these sensors."""
        end_s = (SAMPLES - ONSET) * PERIOD_S
        faults = [Fault("drift", s, None, ONSET * PERIOD_S, end_s, size / PERIOD_S) for s, size in rate.items()]
        return [inject(log, faults).log for log in self.healthy()]

    def at_rate(self) -> Model:
        """With limits under which FAR of healthy runs raise an alarm before the onset, all four sensors alike."""
        score = watch(self.uncalibrated, [_run(self.setting, OTHERS + seed) for seed in range(CALIBRATED)]).score[
            :, :ONSET
        ]
        largest = np.nanmax(np.where(np.isnan(score), 0.0, score), axis=1)
        limit = np.full(len(self.model.channels), np.inf)
        limit[list(JUDGED)] = np.quantile(largest[:, JUDGED], 1 - FAR / len(JUDGED), axis=0)
        return with_limits(self.model, limit)


@cache
def _run(setting: Setting, seed: int, variance: float = VARIANCE) -> Log:
    return run(setting, seed, variance=variance)


def joined(logs: Sequence[Log]) -> Log:
    """Several runs as one log, with pauses between them, over which no window and no filter reaches."""
    starts = np.cumsum([0.0, *(log.duration_s + PAUSE_S for log in logs[:-1])])
    time = [log.time - log.time[0] + start for log, start in zip(logs, starts, strict=True)]
    value, fresh = (np.concatenate([getattr(log, name) for log in logs]) for name in ("value", "fresh"))
    return replace(logs[0], time=np.concatenate(time), value=value, fresh=fresh)


def theta(setting: Setting) -> Float[np.ndarray, " C"]:
    """The paper's thresholds by its own rule: Δ + 3σ, Δ the largest slope times T."""
    steps = np.abs(np.diff(motion(setting).value, axis=0)).max(axis=0)
    limit: Float[np.ndarray, " C"] = np.full(steps.size, np.inf)
    limit[list(JUDGED)] = steps[list(JUDGED)] + 3 * np.sqrt(VARIANCE)
    return limit


def first(result: Result, column: int) -> Int[np.ndarray, " N"]:
    """Sample of the first alarm on a sensor from the onset on; SAMPLES if there is none."""
    fault = result.fault[:, ONSET:, column]
    return np.asarray(np.where(fault.any(axis=1), ONSET + fault.argmax(axis=1), SAMPLES))


def early(result: Result) -> Bool[np.ndarray, " N"]:
    """Whether anything was accused before the onset."""
    return np.asarray(result.fault[:, :ONSET].any(axis=(1, 2)))


def found_soon(result: Result) -> Bool[np.ndarray, " N"]:
    """Whether both drifts were found at sample 51 or 52."""
    return np.asarray(np.all([np.isin(first(result, column), SOON) for column in COLUMNS], axis=0))


def increment_error(result: Result, columns: Sequence[int] = RATES) -> float:
    """Root mean square of the one-step error from the onset on, of runs in which nothing lies [SI]."""
    return float(np.sqrt(np.mean(result.residual[:, ONSET:, list(columns)] ** 2)))
