"""What the methods share that judge a follower's ranges: the filter and the monitor around it."""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError
from sensorfault.model import hold_s, owners
from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.drop import Drop
from sensorfault.monitor.residual.cubature import Cubature
from sensorfault.monitor.residual.measurement_noise import Stated
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.stage import Stage
from sensorfault.vehicles.underwater import Follower, Roles, roles

Q, SIGMA_M, START_M = 0.2, 3.0, 1.0  # [m²/s]; of a range, of the first fix [m]


@dataclass(frozen=True)
class Filter:
    """What the filter takes for granted.

    `q`: variance that a second of dead reckoning adds [m²/s], 1 as printed. `sigma_m`: standard deviation of a range
    [m]. `adaptive`: R* for R. `growth`: share of q that each refused range adds. `repeated`: how many times R is that
    of an exact repeat.
    """

    q: float = Q
    sigma_m: float = SIGMA_M
    adaptive: bool = True
    growth: float = 0.0
    repeated: float = 1.0


def followed(name: str, log: Log) -> Roles:
    """What the log says of a follower.

    Raises:
        LogError: no leader, or no position to begin at.
    """
    found = roles(log)
    if not found.leaders:
        raise LogError(
            f"{log.name} has no sensor with a range [m] and a position, {name} needs one a leader; name the columns in "
            "vehicle.toml, or take another method."
        )
    if not found.position:
        raise LogError(
            f"{log.name} has no position of a sensor without a range, {name} begins at one; give a log with a fix."
        )
    return found


def cubature(log: Log, found: Roles, filter: Filter) -> Cubature:
    """The filter of this log's follower."""
    return Cubature(
        vehicle=Follower(jnp.asarray(filter.q), jnp.asarray(START_M), found),
        r=jnp.full(len(found.leaders), filter.sigma_m**2),
        noise=Stated(filter.adaptive),
        growth=jnp.asarray(filter.growth),
        repeated=jnp.asarray(filter.repeated),
        channels=len(log.channels),
        states=2,
    )


def monitor(
    log: Log, residual: Cubature, statistic: Stage[Any, Any, Any, Any], limit: Float[np.ndarray, " C"]
) -> Monitor:
    """One limit a range; what is over it has gain 0."""
    return Monitor(
        residual=residual,
        branches=(Branch(statistic, Fixed(jnp.asarray(limit))),),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )
