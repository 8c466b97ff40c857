"""Slow drift done right: ramps in the second half of a flight, limits from the first, an independent reference."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import sensorfault._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.methods import drifting
from sensorfault.methods.drifting import DriftTest, Setting
from sensorfault.monitor.monitor import Monitor
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.studies.findings import Effort, Row
from sensorfault.studies.multistep.beats import Beats, compared
from sensorfault.studies.multistep.contenders import watch
from sensorfault.studies.multistep.flights import FLIGHTS, flight
from sensorfault.studies.multistep.slow_rivals import SWEPT, TESTS
from sensorfault.studies.numbers import Numbers

EXPERIMENT, DRIFT = "D-slow", "drift"
RATES = (0.1, 0.3, 1.0)  # [m/s]
EVERY_S, BEGIN_S, LEAST_S = 15.0, 5.0, 100.0  # from one onset to the next, after half of the flight, before its end
WHERE = ("height", "height-and-vd")  # what drifts
WINDOWS = (60.0, 90.0, 110.0, 130.0, 150.0, 180.0)  # of the sweep [s]
SLOTS = 210  # for the longest of them: one compilation serves all
SHORT, PLAIN = "W60", "no-lag"  # the prototype's window; both heights taken to show the same moment
HALF, WHOLE = "first-half", "whole-flight"  # what a limit is learned from


@dataclass(frozen=True)
class Told:
    """Of one test under one limit: scores of the healthy flight; of each rate and onset the delay [s], to the end of
    the flight where nothing was found.

    `chance_s`: the delay without a ramp. `false`: alarms in the second half of the healthy flight, an unbroken run of
    them once; `far`: their share of the beats. `ratio`: largest healthy score of the second half over that of the
    first. `ramped`: the score with the slowest ramp from the middle onset on, `onset_s`.
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


@dataclass
class Slow:
    """Of one flight: numbers, and what the figures show. `windows`: tests with windows of other lengths, by method."""

    data: str
    real: Numbers
    injected: Numbers
    told: dict[tuple[str, str], Told] = field(default_factory=dict)  # by method and variant; limits of the first half
    windows: dict[str, dict[float, Told]] = field(default_factory=dict)

    def rows(self) -> Iterator[Row]:
        """All numbers."""
        yield from self.real.rows()
        yield from self.injected.rows()


def slow(effort: Effort) -> list[Slow]:
    """Both flights.

    Raises:
        LogError: the real data are not there.
    """
    return [_flight(name, i / len(FLIGHTS), effort) for i, name in enumerate(FLIGHTS)]


def _flight(name: str, begun: float, effort: Effort) -> Slow:
    whole = compared(flight(name))
    found = Slow(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"))
    beats, plain = (Beats.of(name, whole, replace(drifting.DEFAULT, lagging=lagging)) for lagging in (True, False))
    for i, (method, test) in enumerate(TESTS.items()):
        effort.tell(f"{name}: {method}, ramps", begun + i / len(TESTS) / len(FLIGHTS))
        swept = () if effort.quick or method not in SWEPT else WINDOWS
        own = replace(test.setting, slots=SLOTS)
        settings = [own, *(replace(own, window_s=w) for w in swept)]
        told = judge(beats, test, settings)
        _add(found, method, "", HALF, told[0])
        _add(found, method, "", WHOLE, judge(beats, test, [own], whole=True)[0])
        if swept:
            found.windows[method] = dict(zip(swept, told[1:], strict=True))
            _add(found, method, SHORT, HALF, told[1 + WINDOWS.index(60.0)])
            _add(found, method, SHORT, WHOLE, judge(beats, test, [settings[1]], whole=True)[0])
            _add(found, method, PLAIN, HALF, judge(plain, test, [own])[0])
    return found


def judge(beats: Beats, test: DriftTest, settings: Sequence[Setting], whole: bool = False) -> list[Told]:
    """Every rate from every onset, for each setting, under its limit from the first half or from the whole flight."""
    log, end = beats.log, float(beats.log.time[-1])
    onsets = np.arange(beats.half + BEGIN_S, end - LEAST_S, EVERY_S)
    cells = [log, *(beats.with_ramp(rate, float(onset)) for rate in RATES for onset in onsets)]
    deaf = [_deaf(beats, test, setting) for setting in settings]
    stacked: Monitor = jax.tree.map(lambda *x: jnp.stack([jnp.asarray(one) for one in x]), *deaf)
    score = watch(stacked, cells).score
    learned = np.inf if whole else beats.half
    return [_told(beats, each, onsets, s.margin, learned) for each, s in zip(score, settings, strict=True)]


def _deaf(beats: Beats, test: DriftTest, setting: Setting) -> Monitor:
    """The monitor of a recipe, for a flight that has been brought to beats."""
    part = replace(beats.fitted, memory_s=jnp.asarray(setting.memory_s))
    return drifting.monitor(beats.log, part, test.statistic(setting, 2), Fixed(jnp.full(2, jnp.inf)), setting)


def _told(
    beats: Beats, score: Float[np.ndarray, "N T"], onsets: Float[np.ndarray, " o"], margin: float, learned_s: float
) -> Told:
    """By scores without consequences: what an alarm changes comes after the first alarm."""
    time, second = beats.log.time, beats.log.time >= beats.half
    limit = margin * float(np.nanmax(score[0, time < learned_s]))
    shape, begun, middle = (len(RATES), len(onsets)), np.tile(onsets, len(RATES)), len(onsets) // 2
    delay, found = _first(time, score[1:] > limit, begun)
    chance, _ = _first(time, np.broadcast_to(score[0] > limit, (len(onsets), len(time))), onsets)
    quiet = score[0, second] > limit
    return Told(
        time=time,
        score=score[0],
        ramped=score[1 + middle],
        onset_s=float(onsets[middle]),
        limit=limit,
        delay=delay.reshape(shape),
        missed=~found.reshape(shape),
        chance_s=float(chance.mean()),
        false=int(quiet[0]) + int((quiet[1:] & ~quiet[:-1]).sum()),
        far=float(quiet.mean()),
        ratio=float(np.nanmax(score[0, second]) / np.nanmax(score[0, ~second])),
    )


def _first(
    time: Float[np.ndarray, " T"], alarm: Bool[np.ndarray, "N T"], begun: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, " N"], Bool[np.ndarray, " N"]]:
    """Time from each onset to the first alarm, or to the end, and whether there was one."""
    after = alarm & (time[None] >= begun[:, None])
    found = np.asarray(after.any(axis=1))
    return np.where(found, time[after.argmax(axis=1)], time[-1]) - begun, found


def _add(found: Slow, method: str, variant: str, learned: str, told: Told) -> None:
    """The barometer knows nothing of the receiver's vertical speed, so it is no matter whether that drifts too."""
    if learned == HALF:
        found.told[method, variant] = told
    words = " ".join(part for part in (variant, learned) if part)
    found.real.add(words, method, {"far": told.far, "false_events": told.false, "healthy_ratio": told.ratio})
    for where in WHERE:
        for rate, delay, missed in zip(RATES, told.delay, told.missed, strict=True):
            numbers = {"delay_s": delay.mean(), "missed": missed.mean(), "chance_delay_s": told.chance_s}
            found.injected.add(f"{words} {where}", method, numbers, DRIFT, rate)
