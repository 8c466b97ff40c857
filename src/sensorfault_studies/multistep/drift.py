"""Ramps on the height of a real flight, with the paper's threshold and at a common false alarm rate."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float

from sensorfault_studies.findings import Effort
from sensorfault_studies.multistep.contenders import Contender, Seen, kinematic, network, watch
from sensorfault_studies.multistep.flights import FLIGHTS, flight
from sensorfault_studies.multistep.flown import SLOPES, Count, Flown, Ramps, count
from sensorfault_studies.numbers import Numbers

EXPERIMENT, DRIFT = "D", "drift"
STEPS = tuple(range(1, 16))
LONG = (*STEPS, 25)  # of the observers without a network
QUICK_STEPS, QUICK_LONG, QUICK_SLOPES = (1, 10, 12), (1, 12, 25), (0.1, 0.5, 1.0)
HARD, HARDER = "far1e-2", "far2e-3"
RATES = {HARD: 0.01, HARDER: 0.002}  # false alarm rates on the training part
MATCHED, PRINTED, CLOSED, ADAPTIVE, WHOLE = "matched1e-2", "as-printed", "closed-loop", "adaptive", "whole-flight"
HEADLINE = (PRINTED, HARD)  # conditions reported for every number of steps
REPORTED = (1, 5, 10, 12, 15, 25)  # numbers of steps reported for the other conditions
SWEPT = (1, 10, 12, 25)  # numbers of steps with every slope reported
SEEDS = 3
OFF = 1e9  # factor that raises the limits beyond every score

Alarms = Bool[np.ndarray, "K N T"]


@dataclass(frozen=True)
class Surface:
    """Numbers of one kind of observer under one condition, by steps, then slope; means over onsets and seeds."""

    steps: tuple[int, ...]
    slopes: tuple[float, ...]
    rate: Float[np.ndarray, "n s"]
    delay: Float[np.ndarray, "n s"]


@dataclass
class Drift:
    """The results of one flight: numbers, and the data of the figures."""

    data: str
    real: Numbers
    injected: Numbers
    contenders: list[Contender] = field(default_factory=list)
    surfaces: dict[tuple[str, str], Surface] = field(default_factory=dict)  # by method and condition
    printed: Seen | None = None  # the network with the threshold of the paper
    ramps: Ramps | None = None


def drifts(effort: Effort) -> list[Drift]:
    """Both flights; with `quick` only one."""
    names = FLIGHTS[:1] if effort.quick else FLIGHTS
    return [_flight(name, (i / len(names), 1 / len(names)), effort) for i, name in enumerate(names)]


def _flight(name: str, share: tuple[float, float], effort: Effort) -> Drift:
    begun, part = share
    effort.progress(f"{name}: reading", begun)
    flown = Flown.of(flight(name))
    slopes = QUICK_SLOPES if effort.quick else SLOPES
    ramps = Ramps.on(flown.judge, slopes)
    result = Drift(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"), ramps=ramps)
    kinds = _kinds(flown, effort)
    for i, (words, build) in enumerate(kinds.items()):
        effort.progress(f"{name}: {words}, fitting", begun + part * i / len(kinds))
        contender = build()
        result.contenders.append(contender)
        effort.progress(f"{name}: {words}, testing", begun + part * (i + 0.5) / len(kinds))
        _judge(result, contender, ramps, slopes)
    return result


def _kinds(flown: Flown, effort: Effort) -> Mapping[str, Callable[[], Contender]]:
    steps, long = (QUICK_STEPS, QUICK_LONG) if effort.quick else (STEPS, LONG)
    seeds = 1 if effort.quick else min(effort.seeds, SEEDS)
    kinds: dict[str, Callable[[], Contender]] = {
        "kinematic": lambda: kinematic(flown, long),
        "network": lambda: network(flown, steps, seeds),
    }
    if not effort.quick:
        kinds["by barometer"] = lambda: kinematic(flown, long, "barometric")
        kinds["separate weights for each step"] = lambda: network(flown, steps, 1, separate=True)
    return kinds


def _judge(result: Drift, contender: Contender, ramps: Ramps, slopes: tuple[float, ...]) -> None:
    """All limits are set on the training part; open loop, as in the paper, except where it says closed."""
    flown, many = contender.flown, len(contender.steps)
    for n, rms in zip(contender.steps, contender.rms(flown.judge), strict=True):
        result.real.add(_words(contender, "", n), contender.method, {"rms": rms})
    uncalibrated = contender.monitors(np.full(many, OFF))
    plain = contender.trained is None and not contender.variant
    flight = Ramps.on(flown.log, slopes) if plain else Ramps.on(flown.log, ())
    whole = watch(uncalibrated, flight.logs)
    learned = whole.score[:, 0, : flown.start]
    seen = watch(uncalibrated, ramps.logs)
    for words, rate in RATES.items():
        _add(result, contender, words, ramps, seen.score > _limit(learned, rate))
    if plain:
        _add(result, contender, f"{HARD} {WHOLE}", flight, whole.score > _limit(learned, RATES[HARD]))
    _add(result, contender, MATCHED, ramps, seen.score > _limit(seen.score[:, 0], RATES[HARD]))
    printed = watch(contender.monitors(np.ones(many)), ramps.logs)
    _add(result, contender, PRINTED, ramps, printed.alarm)
    factor = _limit(learned / whole.limit[:, 0, : flown.start] * OFF, RATES[HARD])[:, 0, 0]
    _add(result, contender, f"{HARD} {ADAPTIVE}", ramps, watch(contender.monitors(factor), ramps.logs).alarm)
    if not contender.variant:
        closed = watch(contender.monitors(factor, closed=True), ramps.logs)
        _add(result, contender, f"{HARD} {ADAPTIVE} {CLOSED}", ramps, closed.alarm)
    if contender.trained and not contender.variant:
        result.printed = printed


def _limit(scores: Float[np.ndarray, "K T"], rate: float) -> Float[np.ndarray, "K 1 1"]:
    """The limit that a share `rate` of the healthy scores exceeds."""
    return np.asarray(np.nanquantile(scores, 1 - rate, axis=1)[:, None, None])


def _words(contender: Contender, condition: str, steps: int) -> str:
    return " ".join(part for part in (condition, contender.variant, f"N{steps}") if part)


def _add(result: Drift, contender: Contender, condition: str, ramps: Ramps, alarm: Alarms) -> None:
    """Rates and delays for each number of steps: the mean over all slopes, and each slope."""
    headline = condition in HEADLINE
    slopes = tuple(dict.fromkeys(ramps.slope[1:].tolist()))
    counts: dict[int, list[list[Count]]] = {}
    for k, n in enumerate(contender.steps):
        words, judged = _words(contender, condition, n), alarm[k, 0, max(contender.steps) :]
        each = [count(ramps, alarm[k], np.flatnonzero(ramps.slope == slope)) for slope in slopes]
        counts.setdefault(n, []).append(each)
        if not headline and n not in REPORTED:
            continue
        chance = count(ramps, alarm[k], np.flatnonzero(ramps.slope > 0), fault=False)
        result.real.add(words, contender.method, {"far": float(judged.mean())})
        _add_counts(result.injected, words, contender.method, mean(each), chance, None)
        if headline and n in SWEPT and not contender.variant:
            for slope, one in zip(slopes, each, strict=True):
                _add_counts(result.injected, words, contender.method, one, chance, slope)
    if not contender.variant:
        rate, delay = (
            np.array([[np.mean([seed[s][i] for seed in counts[n]]) for s in range(len(slopes))] for n in counts])
            for i in range(2)
        )
        result.surfaces[contender.method, condition] = Surface(tuple(counts), slopes, rate, delay)


def mean(counts: list[Count]) -> Count:
    """Mean over several slopes."""
    return Count(*(float(np.mean(x)) for x in zip(*counts, strict=True)))


def _add_counts(numbers: Numbers, words: str, method: str, found: Count, chance: Count, slope: float | None) -> None:
    measured = {"detection_rate": found.rate, "chance": chance.rate, "delay_steps": found.delay}
    measured |= {"chance_delay_steps": chance.delay} | ({"missed": found.missed} if slope is None else {})
    numbers.add(words, method, measured, DRIFT, slope)
