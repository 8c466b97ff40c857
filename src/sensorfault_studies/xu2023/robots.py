"""Five real robots on a floor with fifteen landmarks: ranges to them, and truth from a camera system."""

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Channel
from sensorfault_studies.data import real
from sensorfault_studies.xu2023.ranged_log import START, ranged_log
from sensorfault_studies.xu2023.scenario import Scenario
from sensorfault_studies.xu2023.walks import WRONG, robust_sd

ROBOTS = (1, 2, 3, 4, 5)
FIRST_LANDMARK = 6  # smaller subject numbers are robots
SLOWEST_S = 1.0  # longest time between two ticks [s]
WINDOW_S = 10.0
LEARNED = 1 / 3
ODOMETRY = (Channel("forward", "wheels", "m/s", watch=False), Channel("turn", "wheels", "rad/s", watch=False))
HEADING = Channel("heading", "start", "rad", watch=False)


def _table(name: str) -> Float[np.ndarray, "N c"]:
    folder: Path = real("ranging/mrclam") / "MRCLAM_Dataset6"
    return np.loadtxt(folder / f"{name}.dat.gz")


@cache
def landmarks() -> Float[np.ndarray, "L 2"]:
    """Positions of the landmarks: x and y [m]."""
    return _table("Landmark_Groundtruth")[:, 1:3]


class Run(NamedTuple):
    """Robust `sigma_m` of all ranges and `q` [rad²/s] of the heading, both from the truth of the first third."""

    case: Scenario
    sigma_m: float
    q: float


@cache
def run(robot: int) -> Run:
    """One tick for each round of ranges, and at least one a second; north and east are the file's x and y.

    Starts at the true pose and the first odometry. An error is range minus true distance.
    """
    odometry, truth, received = (_table(f"Robot{robot}_{what}") for what in ("Odometry", "Groundtruth", "Measurement"))
    zero, last = max(odometry[0, 0], truth[0, 0]), min(odometry[-1, 0], truth[-1, 0])
    subject = {int(code): int(who) for who, code in _table("Barcodes")}
    which = np.array([subject.get(int(code), 0) - FIRST_LANDMARK for code in received[:, 1]])
    mine = (which >= 0) & (received[:, 0] > zero) & (received[:, 0] < last)
    received, which = received[mine], which[mine]
    time = np.unique(np.concatenate([np.arange(0.0, last - zero, SLOWEST_S), received[:, 0] - zero]))
    at, near = _true(truth, time + zero), landmarks()
    ranges = np.full((len(time), len(near)), np.nan)
    ranges[np.searchsorted(time, received[:, 0] - zero), which] = received[:, 2]
    errors = ranges - np.linalg.norm(at[:, None] - near, axis=2)
    early = time < LEARNED * time[-1]
    sigma_m = robust_sd(errors[early][np.isfinite(errors[early])])
    own = {**_begun(time, at, truth, zero), **_reckoned(time, odometry, zero)}
    named = {f"landmark{FIRST_LANDMARK + j}": ranges[:, j] for j in range(len(near))}
    case = Scenario(
        log=ranged_log(f"robot {robot}", time, own, named),
        error=errors,
        position=at,
        wrong_m=WRONG * sigma_m,
        since_s=LEARNED * float(time[-1]),
        geodetic=False,
    )
    heading = np.interp(time + zero, truth[:, 0], np.unwrap(truth[:, 3]))
    turned = np.cumsum(own[ODOMETRY[1]] * np.diff(time, prepend=time[0]))
    return Run(case, sigma_m, _strays(time[early], (turned - heading)[early]))


def _strays(time: Float[np.ndarray, " n"], off: Float[np.ndarray, " n"]) -> float:
    """The variance that a second of dead reckoning adds, measured over WINDOW_S."""
    at = np.arange(time[0], time[-1], WINDOW_S)
    return float(np.mean(np.diff(np.interp(at, time, off)) ** 2) / WINDOW_S)


def _true(truth: Float[np.ndarray, "N 4"], at: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n 2"]:
    return np.column_stack([np.interp(at, truth[:, 0], truth[:, i]) for i in (1, 2)])


def _begun(
    time: Float[np.ndarray, " T"], at: Float[np.ndarray, "T 2"], truth: Float[np.ndarray, "N 4"], zero: float
) -> dict[Channel, Float[np.ndarray, " T"]]:
    """The pose at the first tick only."""
    pose = [*at[0], truth[np.searchsorted(truth[:, 0], zero), 3]]
    return {c: np.where(np.arange(len(time)) == 0, x, np.nan) for c, x in zip((*START, HEADING), pose, strict=True)}


def _reckoned(
    time: Float[np.ndarray, " T"], odometry: Float[np.ndarray, "N 3"], zero: float
) -> dict[Channel, Float[np.ndarray, " T"]]:
    """Velocity and turn rate, each the mean since the last tick; a row is valid until the next."""
    at, since = odometry[:, 0] - zero, np.diff(time, prepend=time[0] - 1.0)
    way = [np.concatenate([[0.0], np.cumsum(rate[:-1] * np.diff(at))]) for rate in odometry[:, 1:].T]
    return {c: np.diff(np.interp(time, at, w), prepend=0.0) / since for c, w in zip(ODOMETRY, way, strict=True)}
