"""Real sound under water: a diving robot's beacon and four receivers at unrecorded positions."""

from typing import NamedTuple

import numpy as np
import polars as pl
from jaxtyping import Bool, Float
from scipy.optimize import least_squares

from sensorfault_studies.data import real
from sensorfault_studies.xu2023.ranged_log import START, TAG, ranged_log
from sensorfault_studies.xu2023.scenario import Scenario

LEARNED = 1 / 2
WILD_M = 0.1  # larger errors hardly count in the fit of the receivers' positions [m]
IMPOSSIBLE_M = 0.5  # two ranges may differ by this more than the distance of their receivers [m]


class Dive(NamedTuple):
    """For each round of ranges: time [s], ranges [m], NaN if missing; the device's own x, y and down [m] and
    whether it marks them valid; signal-to-noise ratio of each receiver [dB].
    """

    time: Float[np.ndarray, " T"]
    range: Float[np.ndarray, "T 4"]
    position: Float[np.ndarray, "T 3"]
    solved: Bool[np.ndarray, " T"]
    signal: Float[np.ndarray, "T 4"]

    @property
    def early(self) -> Bool[np.ndarray, " T"]:
        """The rounds of the training part."""
        return np.asarray(self.time < LEARNED * self.time[-1])


def dive() -> Dive:
    """The rounds with a new range; the file repeats the last range until the next.

    Raises:
        LogError: it is not there.
    """
    (file,) = real("underwater/ugps_g2_acoustic").glob("*_acoustic.csv")
    result = pl.read_csv(file, infer_schema_length=None)
    raw = _four(result, "distance")
    new = np.append(False, (np.diff(raw, axis=0) != 0).any(axis=1)) & (raw >= 0).any(axis=1)
    time = result["timestamp"].to_numpy()[new]
    return Dive(
        time=time - time[0],
        range=np.where(raw >= 0, raw, np.nan)[new],
        position=result.select("x", "y", "z").to_numpy()[new],
        solved=result["position_valid"].to_numpy()[new],
        signal=(_four(result, "rssi") - _four(result, "nsd"))[new],
    )


def _four(result: pl.DataFrame, what: str) -> Float[np.ndarray, "T 4"]:
    return result.select(f"{what}_r{i}" for i in range(4)).to_numpy().astype(float)


def placed(of: Dive) -> Float[np.ndarray, "4 3"]:
    """Positions of the receivers, fitted to the ranges and the device's positions in the first half [m]."""
    rows = of.early & of.solved
    ranges, position = of.range[rows], of.position[rows]

    def errors(x: Float[np.ndarray, "12"]) -> Float[np.ndarray, " n"]:
        away = np.linalg.norm(position[:, None] - x.reshape(4, 3), axis=2)
        return np.asarray((ranges - away)[np.isfinite(ranges)])

    return np.asarray(least_squares(errors, np.zeros(12), loss="soft_l1", f_scale=WILD_M).x.reshape(4, 3))


def scenario(of: Dive, receivers: Float[np.ndarray, "4 3"]) -> Scenario:
    """Starts at the device's position, with known depth. `error` and `position` come from the device: no truth."""
    first = np.where(np.arange(len(of.time))[:, None] == 0, of.position, np.nan)
    own = {START[0]: first[:, 0], START[1]: first[:, 1], TAG: of.position[:, 2]}
    ranges = {f"receiver{j}": of.range[:, j] for j in range(4)}
    away = np.linalg.norm(of.position[:, None] - receivers, axis=2)
    return Scenario(
        log=ranged_log("dive", of.time, own, ranges, receivers),
        error=of.range - away,
        position=of.position[:, :2],
        since_s=LEARNED * float(of.time[-1]),
        geodetic=False,
    )


def impossible(of: Dive, receivers: Float[np.ndarray, "4 3"]) -> Bool[np.ndarray, "T 4"]:
    """Ranges that violate |d_i - d_j| ≤ |p_i - p_j| with two others, so they cannot be right if those are."""
    apart = np.linalg.norm(receivers[:, None] - receivers, axis=2)
    differ = np.abs(of.range[:, :, None] - of.range[:, None])
    return np.asarray((differ > apart + IMPOSSIBLE_M).sum(axis=2) >= 2)
