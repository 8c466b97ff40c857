"""Shared by the methods that test satellites with a GNSS/INS filter: framing, filter, monitor, model."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import open_loop
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Log
from sensorfault.numerics.gnss.position import LEAST
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.ins_gnss import InsGnss
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.vehicles.train import ElevationNoise, Grade

MOST = 3  # satellites excluded at one epoch, at most
# A small inertial unit in a vibrating vehicle: noise densities fifteen times those of its data sheet. With these the
# innovations of a real drive have the spread that the filter predicts. The clock is a TCXO.
GRADE = Grade(*(jnp.asarray(x) for x in (1e-3, 0.1, 1e-5, 1e-4, 0.1, 0.19, 5e-3, 0.3, 1.0)))
SIGMA = 1.4, 4.0, float(np.deg2rad(15.0))  # of a pseudorange: at the zenith, added at the horizon [m], decay [rad]
RATE_M_S, WHEEL_M_S, ASIDE_M_S = 0.1, 0.1, 0.2
NORMAL = 0.6745  # median size of a standard normal variable


@dataclass(frozen=True)
class Filter:
    """Setting of the filter. `factor`: of the pseudoranges' standard deviation. `bank`: see InsGnss."""

    factor: float = 1.0
    bank: bool = False
    grade: Grade = GRADE


def navigation(how: Framing, filter: Filter) -> InsGnss:
    """The filter for these satellites."""
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
    """Excludes the worst satellites one by one while enough remain for a position; without branches: limits off."""
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
    """Innovations of a healthy log with the limits off: [SI], and divided by their standard deviations; NaN: none."""

    innovation: Float[np.ndarray, "T C"]
    normalised: Float[np.ndarray, "T C"]


def healthy(how: Framing, epochs: Log, residual: InsGnss) -> Healthy:
    """The innovations of these epochs with the limits off."""
    tape = open_loop(monitor(how, residual), epochs)
    value = np.where(np.asarray(tape.valid), np.asarray(tape.residual), np.nan)
    return Healthy(value, np.asarray(tape.scores[0]) * np.sign(value))


def fitted(how: Framing, epochs: Log, filter: Filter) -> Filter:
    """The filter with the factor that gives the healthy innovations the median size of a normal distribution."""
    factor = filter.factor
    for _ in range(2):
        seen = healthy(how, epochs, navigation(how, Filter(factor, False, filter.grade)))
        factor *= float(np.nanmedian(np.abs(seen.normalised[:, : len(how.satellites)]))) / NORMAL
    return Filter(factor, filter.bank, filter.grade)


def model(
    name: str, log: Log, how: Framing, epochs: Log, own: Monitor, tests: tuple[str, ...], extra: dict[str, Any]
) -> Model:
    """`tests`: the name of each branch's test, one for each channel; with a leading `*` one for all channels.

    `extra` goes into the summary.
    """
    size = np.abs(healthy(how, epochs, own.residual).innovation)  # type: ignore[arg-type]
    received = np.isfinite(size).any(axis=0)
    sigma = np.ones(len(how.channels))
    sigma[received] = np.nanmedian(size[:, received], axis=0) / NORMAL
    typical = float(np.median(sigma[received])) if received.any() else 1.0
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
        sigma=tuple(np.where(received, sigma, typical).tolist()),
        summary={"training_log": log.name, "training_s": log.duration_s, "epochs": len(epochs), **extra},
        framing=how,
    )
