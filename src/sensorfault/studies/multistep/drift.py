"""Ramps on the height of a real flight, under the paper's threshold and at one rate of false alarms."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int
from sensorfault.studies.multistep.flights import FLIGHTS, flight

from sensorfault.monitor.threshold.adaptive import Adaptive
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.studies.findings import Effort
from sensorfault.studies.multistep.contenders import (
    LOUD,
    Contender,
    kinematic,
    network,
    silent,
    watch,
    watch_ramps,
)
from sensorfault.studies.multistep.flown import SLOPES, Flown, Ramps, count
from sensorfault.studies.numbers import Numbers
from sensorfault.training.fixes import Fixes
from sensorfault.training.roll_out import errors

EXPERIMENT, DRIFT = "D", "drift"
STEPS = tuple(range(1, 16))
LONG = (*STEPS, 25)  # of the observers without a network
QUICK_STEPS, QUICK_LONG, QUICK_SLOPES = (1, 10, 12), (1, 12, 25), (0.1, 0.5, 1.0)
RATES = {"far1e-2": 0.01, "far2e-3": 0.002}  # of false alarms on the part that was learned from
MATCHED, PRINTED, CLOSED, ADAPTIVE, WHOLE = "matched1e-2", "as-printed", "closed-loop", "adaptive", "whole-flight"
SEEDS = 3
SWEPT = (1, 10, 12, 25)  # numbers of steps whose every slope is told

Alarms = Bool[np.ndarray, "K N T"]


@dataclass
class Drift:
    """Of one flight: numbers, and what the figures show of them."""

    data: str
    real: Numbers
    injected: Numbers
    contenders: list[Contender] = field(default_factory=list)
    shown: dict[str, Float[np.ndarray, " T"]] = field(default_factory=dict)  # residual and limit of figure 7
    onset: int = 0


def drifts(effort: Effort) -> list[Drift]:
    """Both flights."""
    return [_flight(name, i / len(FLIGHTS), effort) for i, name in enumerate(FLIGHTS)]


def _flight(name: str, share: float, effort: Effort) -> Drift:
    def tell(doing: str, part: float) -> None:
        effort.tell(f"{doing} on {name}", share + part / len(FLIGHTS))

    flown = Flown.of(flight(name))
    told = Drift(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"))
    slopes = QUICK_SLOPES if effort.quick else SLOPES
    ramps = Ramps.on(flown.judge, slopes)
    kinds = _kinds(flown, effort)
    for i, (words, build) in enumerate(kinds.items()):
        tell(f"{words}: fitting", i / len(kinds))
        contender = build()
        told.contenders.append(contender)
        tell(f"{words}: judging", (i + 0.5) / len(kinds))
        _judge(told, contender, ramps)
        if not contender.trained:
            _whole(told, contender, Ramps.on(flown.log, slopes))
    return told


def _kinds(flown: Flown, effort: Effort) -> Mapping[str, Callable[[], Contender]]:
    steps, long = (QUICK_STEPS, QUICK_LONG) if effort.quick else (STEPS, LONG)
    seeds = 1 if effort.quick else min(effort.seeds, SEEDS)
    kinds: dict[str, Callable[[], Contender]] = {
        "kinematic observer": lambda: kinematic(flown, long),
        "observer by barometer": lambda: kinematic(flown, long, "barometric"),
        "network": lambda: network(flown, steps, seeds),
    }
    if not effort.quick:
        kinds["network, weights of its own a step"] = lambda: network(flown, steps, 1, separate=True)
    return kinds


def _judge(told: Drift, contender: Contender, ramps: Ramps) -> None:
    """All limits; the part to judge. Open loop, as the paper, except where it says closed."""
    flown = contender.flown
    _errors(told.real, contender)
    learned = watch(contender.monitors(silent), [flown.learn]).score[:, 0]
    score = watch_ramps(contender.monitors(silent), ramps).score
    for words, rate in RATES.items():
        limit = np.nanquantile(learned, 1 - rate, axis=1)
        _add(told, contender, words, ramps, score > limit[:, None, None])
        if words == "far1e-2":
            closed = contender.monitors(_fixed(limit), closed=True)
            _add(told, contender, f"{words} {CLOSED}", ramps, watch_ramps(closed, ramps).alarm)
    equal = np.nanquantile(score[:, 0], 1 - RATES["far1e-2"], axis=1)
    _add(told, contender, MATCHED, ramps, score > equal[:, None, None])
    ones = watch_ramps(contender.monitors(lambda k: contender.adaptive(1.0, 1.0, k)), ramps)
    _add(told, contender, PRINTED, ramps, ones.alarm)
    loud = watch(contender.monitors(lambda k: contender.adaptive(LOUD, LOUD, k)), [flown.learn])
    factor = np.nanquantile(loud.score[:, 0] / loud.limit[:, 0] * LOUD, 0.99, axis=1)
    scaled = watch_ramps(contender.monitors(_scaled(contender, factor)), ramps)
    _add(told, contender, f"far1e-2 {ADAPTIVE}", ramps, scaled.alarm)
    if contender.trained and not contender.variant:
        _show(told, contender, ramps, ones.score, ones.limit)


def _fixed(limit: Float[np.ndarray, " K"]) -> Callable[[int], Fixed]:
    import jax.numpy as jnp

    return lambda k: Fixed(jnp.asarray(limit[k : k + 1]))


def _scaled(contender: Contender, factor: Float[np.ndarray, " K"]) -> Callable[[int], Adaptive]:
    return lambda k: contender.adaptive(float(factor[k]), float(factor[k]), k)


def _errors(numbers: Numbers, contender: Contender) -> None:
    """Root mean square of the roll-outs on the part to judge."""
    for k, n in enumerate(contender.steps):
        observer = contender.observers[k]
        fixes = Fixes.of(contender.flown.judge, 0, observer.model.columns)
        rms = float(np.sqrt(np.mean(errors(observer.model, fixes, (n,)) ** 2)))
        numbers.add(_words(contender, "", n), contender.method, {"rms": rms})


def _words(contender: Contender, condition: str, steps: int) -> str:
    return " ".join(part for part in (condition, contender.variant, f"N{steps}") if part)


def _add(told: Drift, contender: Contender, condition: str, ramps: Ramps, alarm: Alarms) -> None:
    """Rates and delays of each number of steps: the mean over all slopes, and each slope."""
    faulty = np.flatnonzero(ramps.slope > 0)
    for k, n in enumerate(contender.steps):
        words = _words(contender, condition, n)
        mine = alarm[k]
        judged = mine[0, max(contender.steps) :]
        told.real.add(words, contender.method, {"far": float(judged.mean())})
        _count(told.injected, words, contender.method, ramps, mine, faulty, None)
        for slope in dict.fromkeys(ramps.slope[faulty].tolist()):
            _count(told.injected, words, contender.method, ramps, mine, np.flatnonzero(ramps.slope == slope), slope)


def _count(
    numbers: Numbers,
    words: str,
    method: str,
    ramps: Ramps,
    alarm: Bool[np.ndarray, "N T"],
    cells: Int[np.ndarray, " n"],
    slope: float | None,
) -> None:
    found, chance = count(ramps, alarm, cells), count(ramps, alarm, cells, fault=False)
    told = {"detection_rate": found.rate, "chance": chance.rate, "delay_steps": found.delay}
    told |= {"chance_delay_steps": chance.delay, "missed": found.missed}
    numbers.add(words, method, told, DRIFT, slope)


def _whole(told: Drift, contender: Contender, ramps: Ramps) -> None:
    """Over the whole flight, as the limits that nothing is learned for allow: what the prototypes did."""
    learned = watch(contender.monitors(silent), [contender.flown.learn]).score[:, 0]
    limit = np.nanquantile(learned, 0.99, axis=1)
    score = watch_ramps(contender.monitors(silent), ramps).score
    _add(told, contender, f"far1e-2 {WHOLE}", ramps, score > limit[:, None, None])


def _show(
    told: Drift,
    contender: Contender,
    ramps: Ramps,
    score: Float[np.ndarray, "K N T"],
    limit: Float[np.ndarray, "K N T"],
) -> None:
    """The paper's figure 7: the slowest ramp, N = 1 and N = 10, under the threshold as printed."""
    (cell, *_) = np.flatnonzero(ramps.slope == SLOPES[0])
    told.onset = int(ramps.onset[cell])
    for n in (1, 10):
        k, *_ = contender.of(n)
        told.shown |= {f"residual N{n}": score[k, cell], f"limit N{n}": limit[k, cell]}
