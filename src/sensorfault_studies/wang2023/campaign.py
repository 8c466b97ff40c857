"""Many runs of one drive at once: each has its own pseudorange errors, everything else is shared."""

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

AT_ONCE = 41  # runs at once: two rounds for 81 trials, three for 120 healthy runs
SETTLED = 60  # epochs until the filter has a heading and the windows are full


@dataclass(frozen=True)
class Case:
    """E epochs with error-free pseudoranges, and the true position of the vehicle (ECEF) [m]."""

    framing: Framing
    epochs: Log
    position: Float[np.ndarray, "E 3"]


class Flown(NamedTuple):
    """N runs of E epochs: flagged satellites, largest score of each epoch (NaN: no test), horizontal position error
    [m], and innovations [SI], also divided by their standard deviations (NaN: not tested).
    """

    flagged: Bool[np.ndarray, "N E S"]
    score: Float[np.ndarray, "N E"]
    off_m: Float[np.ndarray, "N E"]
    innovation: Float[np.ndarray, "N E C"]
    normalised: Float[np.ndarray, "N E C"]


@cache
def case(rates: bool = False) -> Case:
    """The real drive with simulated satellites, without pseudorange errors (the range rates have errors).

    Raises:
        LogError: the real drive does not exist.
    """
    ride = drive("gaussian", 0)
    how = framing(ride.log, ride.sky.names, rates)
    log = how.frame(ride.log)
    value = log.value.copy()
    value[:, : len(ride.sky.names)] -= ride.error
    return Case(how, replace(log, value=value), ride.position[ride.epochs])


def flown(monitor: Monitor, of: Case, error: Float[np.ndarray, "N E S"]) -> Flown:
    """Every run from the initial state."""
    parts = [_some(monitor, of, error[first : first + AT_ONCE]) for first in range(0, len(error), AT_ONCE)]
    return Flown(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _some(monitor: Monitor, of: Case, error: Float[np.ndarray, "N E S"]) -> Flown:
    """At most AT_ONCE runs; fewer are filled up to AT_ONCE, so that one compilation serves all."""
    value = np.repeat(of.epochs.value[None], AT_ONCE, axis=0)
    value[: len(error), :, : error.shape[2]] += error
    run = Navigated(*(one[: len(error)] for one in many(monitor, of.epochs, value)))
    innovation = np.where(run.tested, run.innovation, np.nan)
    off_m = horizontal(run.position, of.position)
    return Flown(run.flagged, run.score, off_m, innovation, innovation / run.sigma)


def false_alarms(result: Flown) -> float:
    """Share of the epochs of healthy runs with a flagged satellite."""
    return float(result.flagged[:, SETTLED:].any(axis=2).mean())
