"""Real walks among ultra-wideband anchors; the truth is from a survey-grade receiver."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import polars as pl
from jaxtyping import Float
from scipy.optimize import least_squares

from sensorfault_studies.data import real
from sensorfault_studies.xu2023.ranged_log import START, TAG, ranged_log
from sensorfault_studies.xu2023.scenario import Scenario

LEARNED = 1 / 3  # training share of each walk
WRONG = 5.0  # a range with an error above so many robust standard deviations of its anchor is wrong
PAUSE_S = 0.03  # shortest time between two rounds [s]
WILD_M = 0.1  # larger errors hardly count in the fit of clock and height [m]


class Anchor(NamedTuple):
    """`position`: x, y and up [m]; `time`: of each range, since the track began [s]."""

    position: Float[np.ndarray, "3"]
    time: Float[np.ndarray, " n"]
    range: Float[np.ndarray, " n"]


@dataclass(frozen=True)
class Walk:
    """`track`: time [s], x, y and up [m], of the ground under the tag; anchors by name."""

    name: str
    track: Float[np.ndarray, "N 4"]
    anchors: dict[str, Anchor]

    def at(self, time: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n 3"]:
        """Position of the ground under the tag [m]."""
        return np.column_stack([np.interp(time, self.track[:, 0], self.track[:, i]) for i in (1, 2, 3)])

    def error(self, anchor: Anchor, lag_s: float = 0.0, height_m: float = 0.0) -> Float[np.ndarray, " n"]:
        """Error of each range [m], if it belongs to the tag's position `lag_s` earlier."""
        tag = self.at(anchor.time - lag_s) + np.array([0.0, 0.0, height_m])
        return np.asarray(anchor.range - np.linalg.norm(tag - anchor.position, axis=1))


@cache
def walks() -> tuple[Walk, ...]:
    """All four walks, with the ranges for which there is truth.

    Raises:
        LogError: they are not there.
    """
    return tuple(_walk(folder) for folder in sorted(real("ranging/uwb_outdoor").glob("LOS/*/*")))


def _walk(folder: Path) -> Walk:
    track = pl.read_csv(folder / "trajectory.csv").to_numpy()
    first, last = track[0, 0], track[-1, 0]
    anchors = {}
    for file in sorted(folder.glob("A*.csv")):
        result = pl.read_csv(file)
        result = result.filter(pl.col("%time").cast(pl.Float64).is_between(first, last))
        position = result.select("field.x", "field.y", "field.z").to_numpy()[0]
        time = (result["%time"].to_numpy().astype(float) - first) / 1e9
        anchors[file.stem] = Anchor(position, time, result["field.distanceFromTag"].to_numpy())
    name = folder.parent.name[-1] + folder.name[-1]
    return Walk(name, np.column_stack([(track[:, 0] - first) / 1e9, track[:, 1:4]]), anchors)


class Survey(NamedTuple):
    """From the truth of a walk's first third: clock lag [s], tag height [m], offset and sigma of each anchor [m]."""

    lag_s: float
    height_m: float
    offset: Float[np.ndarray, " L"]
    sigma: Float[np.ndarray, " L"]


def surveyed(walk: Walk) -> Survey:
    """Fits the height of the tag and the lag of its clock, which the file does not contain."""
    until = LEARNED * walk.track[-1, 0]
    early = [Anchor(a.position, a.time[a.time < until], a.range[a.time < until]) for a in walk.anchors.values()]

    def errors(x: Float[np.ndarray, "2"]) -> list[Float[np.ndarray, " n"]]:
        return [walk.error(anchor, *x) for anchor in early]

    found = least_squares(lambda x: np.concatenate(errors(x)), (0.0, 1.0), loss="soft_l1", f_scale=WILD_M).x
    offset = np.array([np.median(e) for e in errors(found)])
    return Survey(float(found[0]), float(found[1]), offset, np.array([robust_sd(e) for e in errors(found)]))


def robust_sd(error: Float[np.ndarray, " n"]) -> float:
    """Robust standard deviation, from the median absolute deviation."""
    return 1.4826 * float(np.median(np.abs(error - np.median(error))))


def scenario(walk: Walk) -> Scenario:
    """One tick for each round of ranges; starts at the first true position, with known height of the tag."""
    known = surveyed(walk)
    time = _rounds(np.unique(np.concatenate([anchor.time for anchor in walk.anchors.values()])))
    ranges, errors = np.full((2, len(time), len(walk.anchors)), np.nan)
    for j, anchor in enumerate(walk.anchors.values()):
        rows = np.searchsorted(time, anchor.time)
        ranges[rows, j] = anchor.range
        errors[rows, j] = walk.error(anchor, known.lag_s, known.height_m) - known.offset[j]
    true = walk.at(time - known.lag_s)
    first = np.where(np.arange(len(time))[:, None] == 0, true[:, :2], np.nan)
    own = {START[0]: first[:, 0], START[1]: first[:, 1], TAG: np.full(len(time), -known.height_m)}
    beacons = np.array([anchor.position for anchor in walk.anchors.values()]) * [1.0, 1.0, -1.0]
    log = ranged_log(f"walk {walk.name}", time, own, dict(zip(walk.anchors, ranges.T, strict=True)), beacons)
    return Scenario(
        log=log,
        error=errors,
        position=true[:, :2],
        wrong_m=WRONG * known.sigma,
        since_s=LEARNED * float(time[-1]),
        geodetic=False,
    )


def _rounds(times: Float[np.ndarray, " n"]) -> Float[np.ndarray, " T"]:
    """The last time of each round; the anchors answer within milliseconds, in ten rounds a second."""
    return np.asarray(times[np.append(np.diff(times) > PAUSE_S, True)])
