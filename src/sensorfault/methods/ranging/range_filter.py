"""Shared by the methods that test a follower's ranges: the filter and the monitor around it."""

from dataclasses import dataclass, replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.calibration.open_loop import open_loop
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import MISSED, hold_s
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.needs import follower
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.cubature import Cubature
from sensorfault.stages.residual.measurement_noise import Stated
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.cubature import likeliest
from sensorfault.training.ranges import submerged
from sensorfault.vehicles.underwater import Follower, FollowerRoles, roles

START_M = 2.0  # standard deviation of the first fix, north and east [m]
GROWTH = 0.5  # used by the recipes; the paper has none
WRONG = 3.0  # an error above so many standard deviations of a range is an anomaly: 9 m for 3 m


@dataclass(frozen=True)
class Filter:
    """Setting of the filter.

    `q`: variance that a second of dead reckoning adds [m²/s], 1 in the paper. `sigma_m`: standard deviation of a range
    [m]. `adaptive`: R* in place of R. `growth`: share by which each rejected range increases q. `repeated`: factor on R
    for an exactly repeated range.
    """

    q: float = 1.0
    sigma_m: float = 3.0
    adaptive: bool = True
    growth: float = 0.0
    repeated: float = 1.0


def followed(name: str, log: Log) -> FollowerRoles:
    """The columns of a follower in this log.

    Raises:
        LogError: no leader, no initial position, or too few ranges.
    """
    follower(name, log)
    return roles(log)


def cubature(log: Log, found: FollowerRoles, filter: Filter) -> Cubature:
    """The filter for the follower of this log."""
    return _cubature(log, found, filter, jnp.asarray(filter.q), jnp.asarray(filter.sigma_m))


def _cubature(
    log: Log, found: FollowerRoles, filter: Filter, q: Float[Array, ""], sigma_m: Float[Array, ""]
) -> Cubature:
    period = {sensor.name: sensor.period_s for sensor in log.sensors}
    return Cubature(
        vehicle=Follower(q, jnp.asarray(START_M), found),
        r=sigma_m**2 * jnp.ones(len(found.leaders)),
        noise=Stated(filter.adaptive),
        growth=jnp.asarray(filter.growth),
        repeated=jnp.asarray(filter.repeated),
        stale_s=jnp.asarray(MISSED * max(period[log.channels[leader.range].sensor] for leader in found.leaders)),
        channels=len(log.channels),
        states=2,
    )


def monitor(log: Log, residual: Cubature, *branches: Branch) -> Monitor:
    """A range over its limit has gain 0; no branches: limits off."""
    silent = Branch(Normalised(), Fixed(jnp.inf * jnp.ones(len(log.channels))))  # not jnp.full, which is weakly typed
    return Monitor(
        residual=residual,
        branches=branches or (silent,),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )


def on_ranges(log: Log, found: FollowerRoles, limits: float | Float[np.ndarray, " L"]) -> Fixed:
    """These limits on the ranges, one for all or one for each leader, and none on the other channels."""
    limit = np.full(len(log.channels), np.inf)
    limit[[leader.range for leader in found.leaders]] = limits
    return Fixed(jnp.asarray(limit))


def fitted(log: Log, found: FollowerRoles, filter: Filter) -> Filter:
    """The filter with the maximum-likelihood noise of this log's innovations; exact repeats are ignored."""
    plain = replace(filter, adaptive=True, growth=0.0, repeated=1e6)
    under = submerged(log, found.position)
    q, sigma_m = likeliest(lambda q, sigma: monitor(log, _cubature(log, found, plain, q, sigma)), under)
    return replace(filter, q=q, sigma_m=sigma_m)


def model(
    name: str,
    log: Log,
    found: FollowerRoles,
    own: Monitor,
    tests: tuple[str, ...],
    filter: Filter,
    extra: dict[str, Any],
) -> Model:
    """`tests`: name of each branch's test, one for each channel; `extra` goes into the summary."""
    ranges = [leader.range for leader in found.leaders]
    uncalibrated = monitor(log, own.residual)  # type: ignore[arg-type]
    tape = open_loop(uncalibrated, submerged(log, found.position))
    sigma = np.ones(len(log.channels))
    for column in ranges:
        seen = tape.residual[tape.valid[:, column], column]
        sigma[column] = 1.4826 * np.median(np.abs(seen))  # robust against outliers in the log
    paths = [channel.path for channel in log.channels]
    mine = np.isin(np.arange(len(paths)), ranges)
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "process_noise_m2_s": filter.q,
        "range_sigma_m": filter.sigma_m,
        **extra,
        "not_watched": {path: "not measured" for path, m in zip(paths, mine, strict=True) if not m},
    }
    return Model(
        method=name,
        monitor=own,
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple((test, path) for test in tests for path in paths),
        watched=tuple(mine.tolist()),
        tick_s=log.period_s,
        sigma=tuple(sigma.tolist()),
        summary=summary,
    )
