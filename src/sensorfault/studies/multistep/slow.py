"""Slow drift done right: ramps in the second half of a flight, limits from the first, an independent reference."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import sensorfault._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Log, Sensor
from sensorfault.methods import cusum, drifting, mean_pair, ramp_glr, slope
from sensorfault.methods.drifting import DriftTest, Setting, Statistic
from sensorfault.monitor.monitor import Monitor
from sensorfault.monitor.residual.difference import Difference
from sensorfault.monitor.statistic.averaged_innovation import AveragedInnovation
from sensorfault.monitor.statistic.ewma import Ewma
from sensorfault.monitor.statistic.windowed_chi_square import WindowedChiSquare
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.studies.findings import Effort, Row
from sensorfault.studies.multistep.contenders import watch
from sensorfault.studies.multistep.flights import FLIGHTS, flight
from sensorfault.studies.numbers import Numbers
from sensorfault.training.tapes import extra_tape
from sensorfault.vehicles.fixed_wing import roles

EXPERIMENT, DRIFT = "D-slow", "drift"
RATES = (0.1, 0.3, 1.0)  # [m/s]
EVERY_S, BEGIN_S, LEAST_S = 15.0, 5.0, 100.0  # from one onset to the next, after half of the flight, before its end
WHERE = ("height", "height-and-vd")  # what drifts
WINDOWS = (60.0, 90.0, 110.0, 130.0, 150.0, 180.0)  # of the sweep [s]
SHORT, PLAIN = "W60", "no-lag"  # the prototype's window; both heights taken to show the same moment
MEMORY_S = 120.0  # of the offset, for tests that want none


def _ewma(setting: Setting, channels: int) -> Statistic:
    return Ewma(jnp.full(channels, setting.window_s / 4), setting.gap_s)


def _averaged(setting: Setting, channels: int) -> Statistic:
    return setting.windowed(AveragedInnovation(), channels)


def _chi_square(setting: Setting, channels: int) -> Statistic:
    return setting.windowed(WindowedChiSquare(), channels)


SLOTS = 210  # for the longest of WINDOWS: one compilation serves all
_FOLLOWING = Setting(memory_s=MEMORY_S, window_s=60.0)
# Beside the recipes tests that are parts only.
TESTS = {
    test.name: test
    for test in (
        slope.TEST,
        mean_pair.TEST,
        ramp_glr.TEST,
        cusum.TEST,
        DriftTest("ewma", _ewma, _FOLLOWING),
        DriftTest("averaged-innovation", _averaged, _FOLLOWING),
        DriftTest("windowed-chi-square", _chi_square, _FOLLOWING),
    )
}
SWEPT = (slope.NAME, mean_pair.NAME, ramp_glr.NAME)  # whose windows are swept; judged without the lag too


@dataclass(frozen=True)
class Beats:
    """A flight from beat to beat: a log of the height minus the barometer, lag taken out, and nought to compare it to.

    `half`: when the second half begins [s]. `when`: the mean time of the fixes of each beat [s].
    """

    log: Log
    when: Float[np.ndarray, " T"]
    half: float
    fitted: Difference

    @classmethod
    def of(cls, name: str, whole: Log, setting: Setting) -> "Beats":
        """The lag is learned from the first half."""
        half = float(whole.time[0]) + whole.duration_s / 2
        part = drifting.difference(name, whole.between(end_s=half), setting)
        beat = extra_tape(part, whole)
        rows = beat.closed
        e = beat.difference[rows] - float(part.lag_s) * beat.speed[rows]
        pair = whole.select(whole.channels[c].path for c in (part.measured, part.reference))
        value = np.column_stack([e, np.zeros_like(e)])
        log = replace(
            pair,
            time=whole.time[rows],
            value=value,
            fresh=np.isfinite(value),
            sensors=tuple(Sensor(sensor.name, setting.beat_s) for sensor in pair.sensors),
        )
        plain = replace(part, lag_s=jnp.zeros(()), measured=0, reference=1, channels=2)
        return cls(log, beat.time[rows], half, plain)

    def with_ramp(self, rate: float, onset_s: float) -> Log:
        """With this ramp on the height."""
        ramp = rate * np.maximum(self.when - onset_s, 0.0)
        return replace(self.log, value=self.log.value + np.column_stack([ramp, 0 * ramp]))


@dataclass(frozen=True)
class Told:
    """Of one test on one flight: scores of the healthy flight, the limit; of each rate and onset the delay [s].

    `false`: alarms in the second half without a fault, an unbroken run of them once; `far`: their share of the beats.
    """

    time: Float[np.ndarray, " T"]
    score: Float[np.ndarray, " T"]
    limit: float
    half: float
    delay: Float[np.ndarray, "rates onsets"]
    missed: Bool[np.ndarray, "rates onsets"]
    false: int
    far: float

    @property
    def ratio(self) -> float:
        """Largest healthy score of the second half over that of the first."""
        second = self.time >= self.half
        return float(np.nanmax(self.score[second]) / np.nanmax(self.score[~second]))


@dataclass
class Slow:
    """Of one flight: numbers, and what the figures show. `windows`: slope and GLR with windows of other lengths."""

    data: str
    real: Numbers
    injected: Numbers
    told: dict[tuple[str, str], Told] = field(default_factory=dict)  # by method and variant
    windows: dict[str, dict[float, Told]] = field(default_factory=dict)

    def rows(self) -> Iterator[Row]:
        """All numbers."""
        yield from self.real.rows()
        yield from self.injected.rows()


def slow(effort: Effort) -> list[Slow]:
    """Both flights."""
    return [_flight(name, i / len(FLIGHTS), effort) for i, name in enumerate(FLIGHTS)]


def _flight(name: str, begun: float, effort: Effort) -> Slow:
    whole = compared(flight(name))
    found = Slow(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"))
    beats, plain = (Beats.of(name, whole, replace(drifting.DEFAULT, lagging=lagging)) for lagging in (True, False))
    for i, (method, test) in enumerate(TESTS.items()):
        effort.tell(f"{name}: {method}, ramps", begun + i / len(TESTS) / len(FLIGHTS))
        swept = () if effort.quick or method not in SWEPT else WINDOWS
        own = replace(test.setting, slots=SLOTS)
        told = judge(beats, test, [own, *(replace(own, window_s=w) for w in swept)])
        _add(found, method, "", told[0])
        if swept:
            found.windows[method] = dict(zip(swept, told[1:], strict=True))
            _add(found, method, SHORT, found.windows[method][WINDOWS[0]])
            _add(found, method, PLAIN, judge(plain, test, [own])[0])
    return found


def compared(whole: Log) -> Log:
    """A flight with its two heights alone, on ticks on which one of them comes."""
    columns = roles(whole)
    pair = whole.select(whole.channels[c].path for c in (columns.height, columns.barometric) if c is not None)
    return pair.without(np.flatnonzero(~pair.fresh.any(axis=1)))


def judge(beats: Beats, test: DriftTest, settings: Sequence[Setting]) -> list[Told]:
    """Every rate from every onset, for each setting under its limit from the first half."""
    log, end = beats.log, float(beats.log.time[-1])
    onsets = np.arange(beats.half + BEGIN_S, end - LEAST_S, EVERY_S)
    cells = [log, *(beats.with_ramp(rate, float(onset)) for rate in RATES for onset in onsets)]
    deaf = [_deaf(beats, test, setting) for setting in settings]
    stacked: Monitor = jax.tree.map(lambda *x: jnp.stack([jnp.asarray(one) for one in x]), *deaf)
    score = watch(stacked, cells).score
    return [_told(beats, each, onsets, setting) for each, setting in zip(score, settings, strict=True)]


def _told(beats: Beats, score: Float[np.ndarray, "N T"], onsets: Float[np.ndarray, " o"], setting: Setting) -> Told:
    """By scores without consequences: what an alarm changes comes after the first alarm."""
    time, end = beats.log.time, float(beats.log.time[-1])
    limit = setting.margin * float(np.nanmax(score[0, time < beats.half]))
    alarm, begun = score > limit, np.tile(onsets, len(RATES))
    after = alarm[1:] & (time[None] >= begun[:, None])
    found = after.any(axis=1)
    delay = np.where(found, time[after.argmax(axis=1)], end) - begun
    quiet = alarm[0, time >= beats.half]
    return Told(
        time=time,
        score=score[0],
        limit=limit,
        half=beats.half,
        delay=delay.reshape(len(RATES), -1),
        missed=~found.reshape(len(RATES), -1),
        false=int(quiet[0]) + int((quiet[1:] & ~quiet[:-1]).sum()),
        far=float(quiet.mean()),
    )


def _deaf(beats: Beats, test: DriftTest, setting: Setting) -> Monitor:
    """The monitor of a recipe, for a flight that has been brought to beats."""
    part = replace(beats.fitted, memory_s=jnp.asarray(setting.memory_s))
    return drifting.monitor(beats.log, part, test.statistic(setting, 2), Fixed(jnp.full(2, jnp.inf)), setting)


def _add(found: Slow, method: str, variant: str, told: Told) -> None:
    """The barometer knows nothing of the receiver's vertical speed, so it is no matter whether that drifts too."""
    found.told[method, variant] = told
    words = " ".join(part for part in (variant, "first-half") if part)
    found.real.add(words, method, {"far": told.far, "false_events": told.false, "healthy_ratio": told.ratio})
    for where in WHERE:
        for i, rate in enumerate(RATES):
            numbers: Mapping[str, float] = {
                "delay_s": float(told.delay[i].mean()),
                "detection_rate": float(1 - told.missed[i].mean()),
            }
            found.injected.add(f"{words} {where}", method, numbers, DRIFT, rate)
