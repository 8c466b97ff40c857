"""What there is to learn of a follower's ranges: those whose error is known, as the filter sees them."""

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.logs.table import Log
from sensorfault.methods.ranging.range_filter import Filter, cubature, monitor
from sensorfault.training.labelled import Labelled
from sensorfault.training.ranges import Lesson, labelled, spoiled, submerged, surfaced
from sensorfault.vehicles.underwater import Follower, FollowerRoles

COPIES = 4  # of the log, each with other faults, to learn from
WIDER = 5.0  # times the usual variance of an innovation: beyond it nothing was learned


def lessons(log: Log, found: FollowerRoles, filter: Filter, seed: int) -> list[Lesson]:
    """The log as it is and copies of it with faults, and how far off each range is.

    The errors are those that the log's fixes show; ranges without a fix are taken for right before faults come in.
    """
    vehicle: Follower = cubature(log, found, filter).vehicle
    known = Lesson(submerged(log, found.position), np.nan_to_num(surfaced(log, vehicle)))
    return [known, *(spoiled(known, vehicle, filter.sigma_m, seed + i) for i in range(COPIES))]


def learned(log: Log, found: FollowerRoles, filter: Filter, of: Sequence[Lesson]) -> list[Labelled]:
    """Features and errors of each leader's ranges."""
    residual = cubature(log, found, filter)
    return labelled(monitor(log, residual), of, residual.vehicle)


def widest(of: Sequence[Labelled]) -> Float[Array, " L"]:
    """Up to which variance of a leader's innovations something was learned of them, and a bit more [m²]."""
    # S = r² / M²
    return jnp.asarray([WIDER * float(np.median(one.features[:, 0] ** 2 / one.features[:, 1])) for one in of])
