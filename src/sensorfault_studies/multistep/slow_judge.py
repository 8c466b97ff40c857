"""One test of a slow drift on one flight: scores for every rate and onset, and the detections with a limit."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.methods.height import drifting
from sensorfault.methods.height.drift_setting import DriftTest, Setting
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault_studies.multistep.beats import Beats
from sensorfault_studies.multistep.contenders import watch

RATES = (0.1, 0.3, 1.0)  # [m/s]
EVERY_S, BEGIN_S, LEAST_S = 15.0, 5.0, 100.0  # between onsets, after the middle of the flight, before its end
HALF = "first-half"  # the limit comes from the first half
MATCHED = "matched0"  # the largest healthy score of the second half: the lowest limit without a false alarm there


@dataclass(frozen=True)
class Result:
    """Results of one test with one limit: scores of the healthy flight, and the delay [s] for each rate and onset.

    Without an alarm the delay is the time to the end of the flight. `chance_s`: the delay without a ramp. `false`:
    alarm events in the second half of the healthy flight; `far`: share of the beats with an alarm there. `ratio`:
    largest healthy score of the second half divided by that of the first. `ramped`: the score with the slowest ramp
    from the middle onset `onset_s` on.
    """

    time: Float[np.ndarray, " T"]
    score: Float[np.ndarray, " T"]
    ramped: Float[np.ndarray, " T"]
    onset_s: float
    limit: float
    delay: Float[np.ndarray, "rates onsets"]
    missed: Bool[np.ndarray, "rates onsets"]
    chance_s: float
    false: int
    far: float
    ratio: float


@dataclass(frozen=True)
class Judged:
    """Open-loop scores of one test: cell 0 without a ramp, then every rate from every onset."""

    beats: Beats
    score: Float[np.ndarray, "N T"]
    onsets: Float[np.ndarray, " o"]
    margin: float

    def judge(self, learned: str) -> Result:
        """Results with the limit of HALF or MATCHED. Closed loop differs only after the first alarm."""
        time, score = self.beats.log.time, self.score
        second = time >= self.beats.half
        first_max, second_max = float(np.nanmax(score[0, ~second])), float(np.nanmax(score[0, second]))
        limit = self.margin * first_max if learned == HALF else second_max
        onsets, middle = self.onsets, len(self.onsets) // 2
        delay, found = _first(time, score[1:] > limit, np.tile(onsets, len(RATES)))
        chance, _ = _first(time, np.broadcast_to(score[0] > limit, (len(onsets), len(time))), onsets)
        quiet = score[0, second] > limit
        return Result(
            time=time,
            score=score[0],
            ramped=score[1 + middle],
            onset_s=float(onsets[middle]),
            limit=limit,
            delay=delay.reshape(len(RATES), -1),
            missed=~found.reshape(len(RATES), -1),
            chance_s=float(chance.mean()),
            false=int(quiet[0]) + int((quiet[1:] & ~quiet[:-1]).sum()),
            far=float(quiet.mean()),
            ratio=second_max / first_max,
        )


def judge(beats: Beats, test: DriftTest, settings: Sequence[Setting]) -> list[Judged]:
    """Every rate from every onset, for each setting."""
    log, end = beats.log, float(beats.log.time[-1])
    onsets = np.arange(beats.half + BEGIN_S, end - LEAST_S, EVERY_S)
    cells = [log, *(beats.with_ramp(rate, float(onset)) for rate in RATES for onset in onsets)]
    uncalibrated = [_uncalibrated(beats, test, setting) for setting in settings]
    stacked: Monitor = jax.tree.map(lambda *x: jnp.stack([jnp.asarray(one) for one in x]), *uncalibrated)
    score = watch(stacked, cells).score
    return [Judged(beats, each, onsets, s.margin) for each, s in zip(score, settings, strict=True)]


def _uncalibrated(beats: Beats, test: DriftTest, setting: Setting) -> Monitor:
    """The monitor of a recipe for a flight averaged to beats, with its limits off."""
    part = replace(beats.fitted, memory_s=jnp.asarray(setting.memory_s))
    return drifting.monitor(beats.log, part, test.statistic(setting, 2), Fixed(jnp.full(2, jnp.inf)), setting)


def _first(
    time: Float[np.ndarray, " T"], alarm: Bool[np.ndarray, "N T"], begun: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, " N"], Bool[np.ndarray, " N"]]:
    """Time from each onset to the first alarm, or to the end, and whether there was one."""
    after = alarm & (time[None] >= begun[:, None])
    found = np.asarray(after.any(axis=1))
    return np.where(found, time[after.argmax(axis=1)], time[-1]) - begun, found
