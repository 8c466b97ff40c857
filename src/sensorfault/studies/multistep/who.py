"""Who is accused when a height drifts: the receiver, its height alone, or the barometer."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool
from scipy.stats import chi2

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.methods import height_agreement
from sensorfault.model import hold_s, owners
from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.drop import Drop
from sensorfault.monitor.statistic.whitened import Whitened
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.replay import Replayed, replay_log
from sensorfault.studies.findings import Effort, Findings
from sensorfault.studies.multistep.flights import FLIGHTS, flight
from sensorfault.studies.numbers import Numbers
from sensorfault.training.height_kalman import fit_height_kalman
from sensorfault.training.session import SILENT
from sensorfault.types import FAULT
from sensorfault.vehicles.fixed_wing import roles

EXPERIMENT, GATE = "D-who", "companion-chi-square"
RATES = (0.3, 1.0)  # [m/s]
LASTS_S, EVERY_S, BEGIN_S, REST_S = 60.0, 15.0, 80.0, 70.0  # of a ramp; from onset to onset; before and after them
ALPHA = 0.01  # of the gate, as the paper's
SENSOR = {"height": "gnss", "height-and-vd": "gnss", "barometer": "barometer"}  # what drifts, and who is at fault


@dataclass(frozen=True)
class Ramp:
    """What drifts, how fast [m/s] upwards, and from when on."""

    what: str
    rate: float
    onset_s: float

    def on(self, log: Log) -> Log:
        """The log with this ramp; nothing of it is left after LASTS_S."""
        paths = {"barometer": ("barometer.altitude",), "height": ("gnss.altitude",)}
        faults = []
        for path in paths.get(self.what, ("gnss.altitude", "gnss.down")):
            channel = log.channels[log.index(path)]
            kind, size = ("bias", -self.rate) if channel.name == "down" else ("drift", self.rate)
            size = from_si(size, channel.unit)
            faults.append(Fault(kind, channel.sensor, channel.name, self.onset_s, LASTS_S, size))
        return inject(log, faults).log


def findings(effort: Effort) -> Findings:
    """All of D-who.

    Raises:
        LogError: the real data are not there.
    """
    told = [_flown(name, effort) for name in FLIGHTS]
    return Findings(tuple(row for one in told for row in one.rows()), (), _remarks(told))


def _flown(name: str, effort: Effort) -> Numbers:
    effort.tell(f"who is accused on {name}", 1.0)
    log = flight(name)
    half = float(log.time[0]) + log.duration_s / 2
    first, rest = log.between(end_s=half), log.between(half)
    monitors = {height_agreement.NAME: height_agreement.build(first, 0, SILENT).monitor, GATE: gate(first)}
    numbers = Numbers(EXPERIMENT, name, "injected")
    onsets = np.arange(half + BEGIN_S, float(log.time[-1]) - REST_S, EVERY_S * (4 if effort.quick else 1))
    for method, monitor in monitors.items():
        healthy = replay_log(monitor, rest)
        for what in SENSOR:
            for rate in RATES:
                for onset in onsets:
                    ramp = Ramp(what, rate, float(onset))
                    told = judged(replay_log(monitor, ramp.on(rest)), rest, ramp)
                    told |= {"chance": float(_during(healthy.sample, rest, ramp).any())}
                    numbers.add(what, method, told, "drift", rate)
    return numbers


def gate(log: Log) -> Monitor:
    """The companion filter; each innovation over the textbook's limit is accused, the largest first, and left out."""
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


def judged(told: Replayed, log: Log, ramp: Ramp) -> dict[str, float]:
    """Of one ramp, while it lasts: whether something was wrong, after how long [s], and who was named."""
    wrong = _during(told.sample, log, ramp)
    times = log.time[(log.time >= ramp.onset_s) & (log.time < ramp.onset_s + LASTS_S)]
    named = {channel.sensor for c, channel in enumerate(log.channels) if _during(told.channel[:, c], log, ramp).any()}
    return {
        "detection_rate": float(wrong.any()),
        "delay_s": float(times[wrong][0] - ramp.onset_s) if wrong.any() else LASTS_S,
        "named": float(SENSOR[ramp.what] in named),
        "wrong_exclusions": float(bool(named - {SENSOR[ramp.what]})),
    }


def _during(verdict: np.ndarray | Array, log: Log, ramp: Ramp) -> Bool[np.ndarray, " n"]:
    rows = (log.time >= ramp.onset_s) & (log.time < ramp.onset_s + LASTS_S)
    return np.asarray(np.asarray(verdict)[rows] == FAULT)


def _remarks(told: Sequence[Numbers]) -> tuple[str, ...]:
    return (
        f"D-who: ramps of {LASTS_S:g} s in the second half, an onset every {EVERY_S:g} s; named: what drifts "
        "is accused meanwhile; wrong_exclusions: another one is; chance: something is wrong without a ramp. "
        f"{GATE}: each innovation of the companion filter under the textbook's limit at {ALPHA:g}, the largest "
        "excluded. Where receiver and barometer are all there is, nobody can tell a receiver whose height and speed "
        "drift together from a barometer that drifts: then the right answer is that something is wrong, and nobody is "
        "named.",
        *(sentence for one in told for sentence in _said(one)),
    )


def _said(one: Numbers) -> Iterator[str]:
    said = []
    for method in (height_agreement.NAME, GATE):
        parts = [
            f"{what} {one.mean(what, method, 'detection_rate', 'drift', 1.0):.0%} found, "
            f"{one.mean(what, method, 'named', 'drift', 1.0):.0%} named, "
            f"{one.mean(what, method, 'wrong_exclusions', 'drift', 1.0):.0%} laid on another, chance "
            f"{one.mean(what, method, 'chance', 'drift', 1.0):.0%}"
            for what in SENSOR
        ]
        said.append(f"{method}: {'; '.join(parts)}")
    yield f"D-who, {one.data}, 1 m/s: {'. '.join(said)}."
