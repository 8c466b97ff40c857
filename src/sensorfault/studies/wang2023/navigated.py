"""Where a filter believed to be, epoch by epoch, and what it found of each satellite."""

from typing import NamedTuple

import sensorfault._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.logs.table import Log
from sensorfault.monitor.monitor import Monitor, MonitorState
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.run import samples
from sensorfault.types import Sample

Numbers = np.ndarray | Array


class Navigated(NamedTuple):
    """T epochs of C channels, as the filter ends each."""

    position: Float[Numbers, "T 3"]  # ECEF [m]
    innovation: Float[Numbers, "T C"]  # [SI]
    sigma: Float[Numbers, "T C"]  # √S_ii
    tested: Bool[Numbers, "T C"]
    taken: Bool[Numbers, "T C"]


def navigated(monitor: Monitor, epochs: Log) -> Navigated:
    """A log of epochs through a monitor whose residual is `InsGnss`, from a fresh start."""
    rows = samples(epochs.time, epochs.value, epochs.fresh, epochs.block)
    return Navigated(*(np.asarray(part) for part in _run(monitor, rows)))


@jax.jit
def _run(monitor: Monitor, rows: Sample) -> Navigated:
    def one(state: MonitorState, sample: Sample) -> tuple[MonitorState, Navigated]:
        after, report = monitor.step(state, sample)
        residual, taken = report.residual, report.trust.measured
        sigma = jnp.sqrt(jnp.diagonal(residual.cov))
        return after, Navigated(after.residual.nav.position, residual.value, sigma, residual.valid, taken)

    done: Navigated = lax.scan(one, monitor.init(), rows)[1]
    return done


def horizontal(position: Float[np.ndarray, "T 3"], true: Float[np.ndarray, "T 3"]) -> Float[np.ndarray, " T"]:
    """How far off on the level [m]; both ECEF [m]."""
    latitude, longitude, _ = ecef_to_geodetic(true)
    off = np.einsum("tij,tj->ti", enu_axes(latitude, longitude), position - true)
    return np.asarray(np.hypot(off[:, 0], off[:, 1]))
