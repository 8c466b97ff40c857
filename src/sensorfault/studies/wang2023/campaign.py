"""Many runs of one drive at once: each with errors of its own in the pseudoranges, all else shared."""

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.logs.epochs import Framing, framing
from sensorfault.monitor.monitor import Monitor, MonitorState
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.run import samples
from sensorfault.studies.wang2023.drive import drive
from sensorfault.types import FAULT, Report, Sample

_Told = tuple[Array, Array, Array, Array, Array]
TOGETHER = 41  # runs at once: two rounds for 81 trials, three for 120 healthy runs
SETTLED = 60  # epochs until the filter has its heading and the windows are full


@dataclass(frozen=True)
class Case:
    """E epochs without errors, and where the vehicle really was (ECEF) [m]; rows of `axes`: east, north, up."""

    framing: Framing
    rows: Sample
    position: Float[np.ndarray, "E 3"]
    axes: Float[np.ndarray, "3 3"]
    elevation: Float[np.ndarray, "E S"]


class Flown(NamedTuple):
    """N runs of E epochs: which satellites are flagged, the largest score of an epoch (NaN: no test), how far off the
    position is on the level [m], and the innovations [SI], themselves and in their standard deviations (NaN: not
    tested).
    """

    flagged: Bool[np.ndarray, "N E S"]
    score: Float[np.ndarray, "N E"]
    off_m: Float[np.ndarray, "N E"]
    innovation: Float[np.ndarray, "N E C"]
    normalised: Float[np.ndarray, "N E C"]


@cache
def case(rates: bool = False) -> Case:
    """The real drive under simulated satellites, without errors of the pseudoranges (those of the rates are there).

    Raises:
        LogError: the real drive is not there.
    """
    ride = drive("gaussian", 0)
    how = framing(ride.log, ride.sky.names, rates)
    log = how.frame(ride.log)
    value = log.value.copy()
    value[:, : len(ride.sky.names)] -= ride.error
    position = ride.position[ride.epochs]
    latitude, longitude, _ = ecef_to_geodetic(position[0])
    rows = samples(log.time, value, log.fresh, log.block)
    return Case(how, rows, position, enu_axes(latitude, longitude), ride.sky.elevation)


def flown(monitor: Monitor, of: Case, error: Float[np.ndarray, "N E S"]) -> Flown:
    """Every run from a fresh start."""
    parts = []
    for first in range(0, len(error), TOGETHER):
        some = error[first : first + TOGETHER]
        whole = np.zeros((TOGETHER, *error.shape[1:]))
        whole[: len(some)] = some
        told = _flown(monitor, of.rows, jnp.asarray(whole))
        parts.append([np.asarray(one)[: len(some)] for one in told])
    flagged, score, position, innovation, normalised = (np.concatenate(column) for column in zip(*parts, strict=True))
    off = (position - of.position) @ of.axes[:2].T
    return Flown(flagged, score, np.linalg.norm(off, axis=2), innovation, normalised)


@jax.jit
def _flown(monitor: Monitor, rows: Sample, error: Float[Array, "N E S"]) -> _Told:
    def one(state: MonitorState, row: tuple[Sample, Array]) -> tuple[MonitorState, _Told]:
        sample, wrong = row
        more = jnp.concatenate([wrong, jnp.zeros(sample.value.size - wrong.size)])
        state, report = monitor.step(state, sample._replace(value=sample.value + more))
        residual = report.residual
        own = jnp.sqrt((jnp.eye(residual.value.size) * residual.cov).sum(axis=1))
        value = jnp.where(residual.valid, residual.value, jnp.nan)
        told = report.verdict.sensor == FAULT, _largest(report), state.residual.nav.position, value, value / own
        return state, told

    def run(error: Array) -> _Told:
        told: _Told = lax.scan(one, monitor.init(), (rows, error))[1]
        return told

    together: _Told = jax.vmap(run)(error)
    return together


def _largest(report: Report) -> Float[Array, ""]:
    """Of the first branch's valid scores."""
    score = report.scores[0]
    largest = jnp.where(score.valid, score.value, -jnp.inf).max()
    return jnp.where(score.valid.any(), largest, jnp.nan)


def false_alarms(told: Flown) -> float:
    """Share of the epochs of healthy runs in which some satellite is flagged."""
    return float(told.flagged[:, SETTLED:].any(axis=2).mean())
