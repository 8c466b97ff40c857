"""The position of a filter at every epoch, and its results for each satellite."""

from typing import NamedTuple

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Sample, Score
from sensorfault.core.verdicts import FAULT
from sensorfault.logs.table import Log
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.runtime.runners import samples


class Navigated(NamedTuple):
    """T epochs of C channels and S satellites, after each update; `score`: the largest of the first branch, or NaN."""

    position: Float[np.ndarray, "*n T 3"]  # ECEF [m]
    innovation: Float[np.ndarray, "*n T C"]  # [SI]
    sigma: Float[np.ndarray, "*n T C"]  # √S_ii
    tested: Bool[np.ndarray, "*n T C"]
    taken: Bool[np.ndarray, "*n T C"]
    flagged: Bool[np.ndarray, "*n T S"]
    score: Float[np.ndarray, "*n T"]


def navigated(monitor: Monitor, epochs: Log) -> Navigated:
    """Run a monitor with residual `InsGnss` over a log of epochs, from the initial state."""
    return Navigated(*(np.asarray(part) for part in _run(monitor, _rows(epochs))))


def many(monitor: Monitor, epochs: Log, values: Float[np.ndarray, "N T C"]) -> Navigated:
    """Run the same log N times with different values, all at once."""
    return Navigated(*(np.asarray(part) for part in _fleet(monitor, _rows(epochs), jnp.asarray(values))))


def _rows(epochs: Log) -> Sample:
    return samples(epochs.time, epochs.value, epochs.fresh, epochs.block)


@jax.jit
def _run(monitor: Monitor, rows: Sample) -> tuple[Array, ...]:
    def one(state: MonitorState, sample: Sample) -> tuple[MonitorState, tuple[Array, ...]]:
        after, report = monitor.step(state, sample)
        residual, at = report.residual, after.residual.nav.position
        sigma = jnp.sqrt(jnp.diagonal(residual.cov))
        flagged = report.verdict.sensor == FAULT
        kept = at, residual.value, sigma, residual.valid, report.trust.measured, flagged, _largest(report.scores[0])
        return after, kept

    done: tuple[Array, ...] = lax.scan(one, monitor.init(), rows)[1]
    return done


def _largest(score: Score) -> Float[Array, ""]:
    largest = jnp.where(score.valid, score.value, -jnp.inf).max()
    return jnp.where(score.valid.any(), largest, jnp.nan)


@jax.jit
def _fleet(monitor: Monitor, rows: Sample, values: Float[Array, "N T C"]) -> tuple[Array, ...]:
    done: tuple[Array, ...] = jax.vmap(lambda value: _run(monitor, rows._replace(value=value)))(values)
    return done


def horizontal(position: Float[np.ndarray, "*n T 3"], true: Float[np.ndarray, "T 3"]) -> Float[np.ndarray, "*n T"]:
    """Horizontal position error [m]; both positions ECEF [m]."""
    latitude, longitude, _ = ecef_to_geodetic(true)
    off = np.einsum("tij,...tj->...ti", enu_axes(latitude, longitude), position - true)
    return np.asarray(np.hypot(off[..., 0], off[..., 1]))
