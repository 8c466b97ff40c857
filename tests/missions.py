"""Missions under water that several tests share, and the monitor of one with its limits off."""

from functools import cache

import jax.numpy as jnp
import numpy as np

from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Sample
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.range_filter import Filter, cubature, followed, monitor
from sensorfault.runtime.runners import samples
from sensorfault.simulation.underwater import Mission, sail

RANGES = 6, 10


@cache
def healthy() -> Mission:
    """Fifteen minutes, with fixes all the time."""
    return sail(900.0, seed=4, surface_s=np.inf)


def uncalibrated(log: Log, filter: Filter = Filter(q=0.1)) -> Monitor:  # noqa: B008
    return monitor(log, cubature(log, followed("test", log), filter))


def rows(log: Log) -> Sample:
    return samples(log.time, log.value, log.fresh)


def metres(log: Log, at: np.ndarray) -> np.ndarray:
    """Latitude and longitude as metres north and east of the first fix."""
    from sensorfault.numerics.local import east_north

    first = log.value[0, :2]
    return np.array([np.asarray(east_north(*jnp.asarray(one), *jnp.asarray(first)))[::-1] for one in at])
