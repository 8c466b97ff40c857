"""What the methods share that judge satellites by an inertial navigation: framing, filter, monitor, model."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.epochs import ON_L1, Framing, framing
from sensorfault.logs.satellites import satellites
from sensorfault.logs.table import Log, LogError
from sensorfault.numerics.alignment import LEAST
from sensorfault.runtime.model import Model, owners
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.ins_gnss import InsGnss
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.vehicles.train import ElevationNoise, Grade

SYSTEMS = {"G": 32, "R": 27, "E": 36, "C": 63, "J": 10}  # how many satellites each numbers
WHEEL = "wheel.speed"
MOST = 3  # satellites left out at one epoch
FEW = 60  # epochs to fit on
# A small unit in a vehicle that shakes: as densities fifteen times those of its data sheet, with which the innovations
# of a real drive have the spread that the filter claims; the clock is a TCXO's.
GRADE = Grade(*(jnp.asarray(x) for x in (1e-3, 0.1, 1e-5, 1e-4, 0.1, 0.19, 5e-3, 0.3, 1.0)))
SIGMA = 1.4, 4.0, float(np.deg2rad(15.0))  # of a pseudorange: overhead, more on the horizon [m], over this [rad]
RATE_M_S, WHEEL_M_S, ASIDE_M_S = 0.1, 0.1, 0.2
NORMAL = 0.6745  # a normal number is as often within this as not


@dataclass(frozen=True)
class Filter:
    """What the filter takes for granted. `factor`: of the pseudoranges' standard deviation. `bank`: see InsGnss."""

    factor: float = 1.0
    bank: bool = False
    grade: Grade = GRADE


def framed(name: str, log: Log) -> Framing:
    """How the log becomes epochs: a slot for each satellite that its systems number, Dopplers where some are of L1.

    Raises:
        LogError: no satellite has a corrected pseudorange and a place, or there are too few epochs.
    """
    seen = satellites(log, "".join(SYSTEMS))
    letters = [letter for letter in SYSTEMS if any(one[0] == letter for one in seen.names)]
    most = {letter: max(int(one[1:]) for one in seen.names if one[0] == letter) for letter in letters}
    names = tuple(f"{x}{i:02d}" for x in letters for i in range(1, max(SYSTEMS[x], most[x]) + 1))
    rates = bool(np.isfinite(seen.doppler[:, [one[0] in ON_L1 for one in seen.names]]).any())
    wheel = WHEEL if any(channel.path == WHEEL for channel in log.channels) else ""
    how = framing(log, names, rates, wheel)
    epochs = int((np.isfinite(seen.corrected).sum(axis=1) >= LEAST).sum())
    if epochs < FEW:
        raise LogError(
            f"{log.name} has {epochs} epochs with {LEAST} satellites, {name} needs {FEW}; give a longer log."
        )
    return how


def navigation(how: Framing, filter: Filter) -> InsGnss:
    """The filter of these satellites."""
    letters = list(dict.fromkeys(one[0] for one in how.satellites))
    zenith, horizon, scale = (jnp.asarray(x) for x in SIGMA)
    return InsGnss(
        grade=filter.grade,
        noise=ElevationNoise(zenith, horizon, scale, jnp.asarray(filter.factor)),
        rate_sigma=jnp.asarray(RATE_M_S),
        wheel=jnp.asarray(WHEEL_M_S),
        aside=jnp.asarray(ASIDE_M_S),
        system=tuple(letters.index(one[0]) for one in how.satellites),
        rates=how.rates,
        bank=filter.bank,
    )


def monitor(
    how: Framing, residual: InsGnss, *branches: Branch, recovery: Stage[Any, Any, Any, Any] | None = None
) -> Monitor:
    """The worst are left out, one after the other, as long as more remain than tell a position; without branches
    with the limits off.
    """
    channels = len(how.channels)
    return Monitor(
        residual=residual,
        branches=branches or (Branch(Normalised(), Fixed(jnp.inf * jnp.ones(channels))),),
        decision=Exceed(),
        recovery=recovery or Drop(),
        hold_s=jnp.zeros(channels),
        owner=owners(how.channels, how.sensors),
        most=MOST,
        least=LEAST * len(how.names),
    )


class Healthy(NamedTuple):
    """Innovations of a healthy log that is taken in whole: [SI], and in their standard deviations; NaN: none."""

    innovation: Float[np.ndarray, "T C"]
    normalised: Float[np.ndarray, "T C"]


def healthy(how: Framing, epochs: Log, residual: InsGnss) -> Healthy:
    """What the filter makes of it with the limits off."""
    tape = replay_log(monitor(how, residual), epochs)
    value = np.where(np.asarray(tape.valid), np.asarray(tape.residual), np.nan)
    return Healthy(value, np.asarray(tape.scores[0]) * np.sign(value))


def fitted(how: Framing, epochs: Log, filter: Filter) -> Filter:
    """With the factor by which half of the healthy innovations are within what is half of a normal law."""
    factor = filter.factor
    for _ in range(2):
        seen = healthy(how, epochs, navigation(how, Filter(factor, False, filter.grade)))
        factor *= float(np.nanmedian(np.abs(seen.normalised[:, : len(how.satellites)]))) / NORMAL
    return Filter(factor, filter.bank, filter.grade)


def model(
    name: str, log: Log, how: Framing, epochs: Log, own: Monitor, tests: tuple[str, ...], result: dict[str, Any]
) -> Model:
    """`tests` names what each branch tests of each channel, behind a `*` if of all at once."""
    size = np.abs(healthy(how, epochs, own.residual).innovation)  # type: ignore[arg-type]
    calibrated = np.isfinite(size).any(axis=0)
    sigma = np.ones(len(how.channels))
    sigma[calibrated] = np.nanmedian(size[:, calibrated], axis=0) / NORMAL
    everyone = float(np.median(sigma[calibrated])) if calibrated.any() else 1.0
    paths = [channel.path for channel in how.channels]
    named: list[tuple[str, str | None]] = []
    for test in tests:
        named += [(test[1:], None)] if test.startswith("*") else [(test, path) for path in paths]
    return Model(
        method=name,
        monitor=own,
        channels=how.channels,
        sensors=how.sensors,
        tests=tuple(named),
        watched=(True,) * len(paths),
        tick_s=how.period_s,
        sigma=tuple(np.where(calibrated, sigma, everyone).tolist()),
        summary={"training_log": log.name, "training_s": log.duration_s, "epochs": len(epochs), **result},
        framing=how,
    )
