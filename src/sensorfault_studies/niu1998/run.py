"""The paper's run: two sensors drift from sample 50 on, monitored by one method with its limits."""

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
SOON = (51, 52)  # the paper detects both at 51
WITHIN = 10  # samples
SENSORS = ("tachometer2", "encoder2")  # y2, y4
COLUMNS = (1, 3)
RATES = (0, 1)
JUDGED = (0, 1, 2, 3)
FAR = 0.05  # share of runs with an alarm before the onset
RUNS = 40  # test runs with different noise for each seed of the study
CALIBRATED = 400  # other runs, for the limits
LEARN = 30  # healthy runs for the fit
PAUSE_S = 1.0  # gap in the clock between two joined runs [s]
LEARNED, OTHERS = 1_000_000, 500_000  # first seeds, far from those of the test runs


@dataclass(frozen=True)
class Watched:
    """A method's model for one seed, and its test runs."""

    setting: Setting
    model: Model
    seeds: range

    @classmethod
    def of(cls, rival: Rival, setting: Setting, seed: int) -> "Watched":
        """Fitted on runs that are not used for the test."""
        learned = joined([_run(setting, LEARNED + LEARN * seed + i) for i in range(LEARN)])
        return cls(setting, rival.build(learned, seed), range(RUNS * seed, RUNS * (seed + 1)))

    @property
    def uncalibrated(self) -> Model:
        """The model with its limits off."""
        return with_limits(self.model, np.full(len(self.model.channels), np.inf))

    def healthy(self, variance: float = VARIANCE) -> list[Log]:
        """The test runs without faults."""
        return [_run(self.setting, seed, variance) for seed in self.seeds]

    def drifting(self, rate: Mapping[str, float]) -> list[Log]:
        """The test runs with drifts [SI a sample] on these sensors."""
        end_s = (SAMPLES - ONSET) * PERIOD_S
        faults = [Fault("drift", s, None, ONSET * PERIOD_S, end_s, size / PERIOD_S) for s, size in rate.items()]
        return [inject(log, faults).log for log in self.healthy()]

    def at_rate(self) -> Model:
        """The model with limits such that FAR of healthy runs raise an early alarm, shared equally by all sensors."""
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
    """Several runs as one log, with gaps between them that no window and no filter bridges."""
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
    """Whether there was an alarm before the onset."""
    return np.asarray(result.fault[:, :ONSET].any(axis=(1, 2)))


def found_soon(result: Result) -> Bool[np.ndarray, " N"]:
    """Whether both drifts were detected at sample 51 or 52."""
    return np.asarray(np.all([np.isin(first(result, column), SOON) for column in COLUMNS], axis=0))


def increment_error(result: Result, columns: Sequence[int] = RATES) -> float:
    """RMS of the one-step error from the onset on, for healthy runs [SI]."""
    return float(np.sqrt(np.mean(result.residual[:, ONSET:, list(columns)] ** 2)))
