"""Many runs of one drive at once: each with errors of its own in the pseudoranges, all else shared."""

from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.logs.epochs import Framing, framing
from sensorfault.logs.table import Log
from sensorfault_studies.wang2023.drive import drive
from sensorfault_studies.wang2023.navigated import Navigated, horizontal, many

TOGETHER = 41  # runs at once: two rounds for 81 trials, three for 120 healthy runs
SETTLED = 60  # epochs until the filter has its heading and the windows are full


@dataclass(frozen=True)
class Case:
    """E epochs whose pseudoranges have no errors, and where the vehicle really was (ECEF) [m]."""

    framing: Framing
    epochs: Log
    position: Float[np.ndarray, "E 3"]


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
    return Case(how, replace(log, value=value), ride.position[ride.epochs])


def flown(monitor: Monitor, of: Case, error: Float[np.ndarray, "N E S"]) -> Flown:
    """Every run from a fresh start."""
    parts = [_some(monitor, of, error[first : first + TOGETHER]) for first in range(0, len(error), TOGETHER)]
    return Flown(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _some(monitor: Monitor, of: Case, error: Float[np.ndarray, "N E S"]) -> Flown:
    """At most TOGETHER of them; the rest of as many is flown for nothing, so that all are compiled once."""
    value = np.repeat(of.epochs.value[None], TOGETHER, axis=0)
    value[: len(error), :, : error.shape[2]] += error
    result = Navigated(*(one[: len(error)] for one in many(monitor, of.epochs, value)))
    innovation = np.where(result.tested, result.innovation, np.nan)
    off_m = horizontal(result.position, of.position)
    return Flown(result.flagged, result.score, off_m, innovation, innovation / result.sigma)


def false_alarms(result: Flown) -> float:
    """Share of the epochs of healthy runs in which some satellite is flagged."""
    return float(result.flagged[:, SETTLED:].any(axis=2).mean())
