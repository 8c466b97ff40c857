"""Which sensor is isolated when the receiver, its height alone, or the barometer drifts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool
from scipy.stats import chi2

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.methods.height import height_agreement, kinematic_observer
from sensorfault.runtime.model import owners
from sensorfault.runtime.replay import Replayed, replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.height_kalman import fit_height_kalman
from sensorfault.training.session import SILENT
from sensorfault.vehicles.fixed_wing import roles
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.multistep.flights import FLIGHTS, flight
from sensorfault_studies.numbers import Numbers

EXPERIMENT, GATE = "D-who", "companion-chi-square"
RATES = (0.3, 1.0)  # [m/s]
REPORTED = ("detection_rate", "named", "wrong_exclusions", "chance")
LASTS_S, EVERY_S, BEGIN_S, REST_S = 60.0, 15.0, 80.0, 70.0  # length of a ramp; between onsets; before and after them
ALPHA = 0.01  # false alarm rate of the gate, as in the paper
TEXTBOOK, CALM = "textbook", "calm"  # its limits: by ALPHA, or above all healthy scores of the first half
SETTLED_S, MARGIN = 30.0, 1.1  # start of the filter, which is ignored; factor on the largest healthy score after it
SENSOR = {"height": "gnss", "height-and-vd": "gnss", "barometer": "barometer"}  # what drifts, and the faulty sensor


@dataclass(frozen=True)
class Ramp:
    """What drifts, how fast [m/s] upwards, and from when on."""

    what: str
    rate: float
    onset_s: float

    def on(self, log: Log) -> Log:
        """The log with this ramp, which ends after LASTS_S."""
        paths = {"barometer": ("barometer.altitude",), "height": ("gnss.altitude",)}
        faults = []
        for path in paths.get(self.what, ("gnss.altitude", "gnss.down")):
            channel = log.channels[log.index(path)]
            kind, size = ("offset", -self.rate) if channel.name == "down" else ("drift", self.rate)
            size = from_si(size, channel.unit)
            faults.append(Fault(kind, channel.sensor, channel.name, self.onset_s, LASTS_S, size))
        return inject(log, faults).log


def findings(effort: Effort) -> Findings:
    """All of D-who.

    Raises:
        LogError: the real data do not exist.
    """
    result = [_flown(name, effort) for name in FLIGHTS]
    return Findings(tuple(row for one in result for row in one.rows()), (), _remarks(result))


def _flown(name: str, effort: Effort) -> Numbers:
    effort.progress(f"isolation on {name}", 1.0)
    log = flight(name)
    half = float(log.time[0]) + log.duration_s / 2
    first, rest = log.between(end_s=half), log.between(half)
    numbers = Numbers(EXPERIMENT, name, "injected")
    onsets = np.arange(half + BEGIN_S, float(log.time[-1]) - REST_S, EVERY_S * (4 if effort.quick else 1))
    for (method, variant), monitor in _rivals(first).items():
        healthy = replay_log(monitor, rest)
        for what, rate, onset in product(SENSOR, RATES, onsets):
            ramp = Ramp(what, rate, float(onset))
            measured = judged(replay_log(monitor, ramp.on(rest)), rest, ramp)
            measured |= {"chance": float(_during(healthy.sample, rest, ramp).any())}
            numbers.add(f"{what} {variant}".strip(), method, measured, "drift", rate)
    return numbers


def _rivals(healthy: Log) -> dict[tuple[str, str], Monitor]:
    """The monitors by method and variant, all fitted on this part of a flight."""
    recipes = (height_agreement.RECIPE, kinematic_observer.RECIPE)
    textbook = gate(healthy)
    return {
        **{(recipe.name, ""): recipe.build(healthy, 0, SILENT).monitor for recipe in recipes},
        (GATE, TEXTBOOK): textbook,
        (GATE, CALM): calmed(textbook, healthy),
    }


def calmed(gated: Monitor, log: Log) -> Monitor:
    """The monitor with limits a margin above all healthy scores after the filter's start."""
    score = np.asarray(replay_log(uncalibrated(gated), log).scores[0])[log.time > log.time[0] + SETTLED_S]
    (branch,) = gated.branches
    limit = Fixed(jnp.asarray(MARGIN * np.nanmax(score, axis=0)))
    return replace(gated, branches=(replace(branch, threshold=limit),))


def gate(log: Log) -> Monitor:
    """The companion filter; the sensor with the largest innovation above the textbook limit is named and excluded."""
    found = roles(log)
    assert found.height is not None
    outputs = tuple((c,) for c in (found.height, found.vertical, found.barometric) if c is not None)
    limit = float(np.sqrt(chi2.ppf(1 - ALPHA, 1)))
    channels = len(log.channels)
    return Monitor(
        residual=fit_height_kalman(log, found.height, found),
        branches=(Branch(Whitened(outputs, channels), Fixed(jnp.full(len(outputs), limit))),),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        most=1,
        together=False,
    )


def judged(result: Replayed, log: Log, ramp: Ramp) -> dict[str, float]:
    """Results during one ramp: whether a fault was detected, the delay [s], and which sensors were named."""
    wrong = _during(result.sample, log, ramp)
    times = log.time[(log.time >= ramp.onset_s) & (log.time < ramp.onset_s + LASTS_S)]
    named = {channel.sensor for c, channel in enumerate(log.channels) if _during(result.channel[:, c], log, ramp).any()}
    return {
        "detection_rate": float(wrong.any()),
        "delay_s": float(times[wrong][0] - ramp.onset_s) if wrong.any() else LASTS_S,
        "named": float(SENSOR[ramp.what] in named),
        "wrong_exclusions": float(bool(named - {SENSOR[ramp.what]})),
    }


def _during(verdict: np.ndarray | Array, log: Log, ramp: Ramp) -> Bool[np.ndarray, " n"]:
    rows = (log.time >= ramp.onset_s) & (log.time < ramp.onset_s + LASTS_S)
    return np.asarray(np.asarray(verdict)[rows] == FAULT)


def _remarks(result: Sequence[Numbers]) -> tuple[str, ...]:
    jump, drift = height_agreement.MARGIN * height_agreement.FINEST_M
    return (
        f"D-who: ramps of {LASTS_S:g} s in the second half, an onset every {EVERY_S:g} s (the seeds of a row). named: "
        "the drifting sensor is named during the ramp. wrong_exclusions: another sensor is named. chance: a fault is "
        f"reported without a ramp. {GATE}: each innovation of the companion filter against the textbook limit at "
        f"{ALPHA:g}, or against limits above all scores of the first half ({CALM}); the largest is excluded. "
        f"{kinematic_observer.NAME} uses the receiver alone; the tests of D-slow name it whichever sensor drifts. "
        "With receiver and barometer alone, a receiver whose height and speed drift together cannot be distinguished "
        "from a drifting barometer: the right answer is then 'unknown which'. The smallest limits of "
        f"{height_agreement.NAME}, {jump:.3g} m for a jump and {drift:.3g} m for a drift, were chosen after these "
        "flights and those of two copters, whose healthy data exceed lower limits.",
        *(sentence for one in result for sentence in _sentences(one)),
    )


def _sentences(one: Numbers) -> Iterator[str]:
    """One sentence for each rate, with all methods."""
    rivals = {key.method: key.condition.split()[1:] for key in one.values}
    variants = {method: (TEXTBOOK, CALM) if words else ("",) for method, words in rivals.items()}
    for rate in RATES:
        numbers = []
        for method, variant in ((m, v) for m, vs in variants.items() for v in vs):
            parts = []
            for what in SENSOR:
                words = f"{what} {variant}".strip()
                share = [one.mean(words, method, metric, "drift", rate) for metric in REPORTED]
                parts.append(f"{what} {' / '.join(f'{x:.0%}' for x in share)}")
            numbers.append(f"{method} {variant}".strip() + f": {', '.join(parts)}")
        yield f"D-who, {one.data}, {rate:g} m/s, detected / named / another named / chance: {'; '.join(numbers)}."
