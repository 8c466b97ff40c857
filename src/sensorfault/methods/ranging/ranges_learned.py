"""Training data from a follower's ranges: the filter's features of ranges whose error is known."""

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.logs.table import Log
from sensorfault.methods.ranging.range_filter import Filter, cubature, monitor
from sensorfault.training.labelled import Labelled
from sensorfault.training.ranges import Lesson, labelled, spoiled, submerged, surfaced
from sensorfault.vehicles.underwater import Follower, FollowerRoles

COPIES = 4  # copies of the log for training, each with other faults
WIDER = 5.0  # times the usual variance of an innovation: the training data do not cover more


def lessons(log: Log, found: FollowerRoles, filter: Filter, seed: int) -> list[Lesson]:
    """The log as it is and copies with injected faults, with the error of each range.

    The errors come from the fixes in the log; a range without a fix is assumed correct before injection.
    """
    vehicle: Follower = cubature(log, found, filter).vehicle
    known = Lesson(submerged(log, found.position), np.nan_to_num(surfaced(log, vehicle)))
    return [known, *(spoiled(known, vehicle, filter.sigma_m, seed + i) for i in range(COPIES))]


def learned(log: Log, found: FollowerRoles, filter: Filter, of: Sequence[Lesson]) -> list[Labelled]:
    """Features and errors of each leader's ranges."""
    residual = cubature(log, found, filter)
    return labelled(monitor(log, residual), of, residual.vehicle)


def widest(of: Sequence[Labelled]) -> Float[Array, " L"]:
    """Variance of each leader's innovations up to which the training data are valid, with some margin [m²]."""
    # S = r² / M²
    return jnp.asarray([WIDER * float(np.median(one.features[:, 0] ** 2 / one.features[:, 1])) for one in of])
