"""Real drives with spikes of one sample, and the score of a monitor's multivariate test for every row."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.logs.read import read
from sensorfault.logs.table import Log
from sensorfault.runtime.replay import replay_log
from sensorfault_studies.data import real

IMU = tuple(f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz")
LEARN = 0.6  # share of a drive for the fit
EVERY = 12  # rows of a block; each block has one spike


@dataclass(frozen=True)
class Drive:
    """The inertial channels of a drive: the part for the fit and the rest, both as recorded."""

    name: str
    learn: Log
    rest: Log

    @classmethod
    def of(cls, name: str) -> "Drive":
        """The drive in this folder of `road`."""
        return cls.split(name, read(real(f"road/{name}")))

    @classmethod
    def split(cls, name: str, log: Log) -> "Drive":
        """Split the time into 60 % and 40 %."""
        imu = log.select(IMU)
        cut = float(imu.time[0]) + LEARN * imu.duration_s
        return cls(name, imu.between(end_s=cut), imu.between(cut))

    @property
    def sigma(self) -> Float[np.ndarray, " C"]:
        """Standard deviation of each channel over the part for the fit [SI]."""
        sigma: Float[np.ndarray, " C"] = np.nanstd(self.learn.value, axis=0)
        return sigma


def spiked(drive: Drive, size: float, seed: int) -> tuple[Log, Bool[np.ndarray, " T"]]:
    """The rest of the drive with one spike of `size` channel sigmas in each block; row, channel and sign are random."""
    random = np.random.default_rng(seed)
    blocks = len(drive.rest) // EVERY
    rows = EVERY * np.arange(blocks) + random.integers(0, EVERY, blocks)
    channels = random.integers(0, len(drive.sigma), blocks)
    value = drive.rest.value.copy()
    value[rows, channels] += size * drive.sigma[channels] * random.choice((-1.0, 1.0), blocks)
    faulty = np.zeros(len(value), bool)
    faulty[rows] = True
    return replace(drive.rest, value=value), faulty


class Judgement(NamedTuple):
    """For every row the score of the multivariate test, and the residual [SI]."""

    score: Float[np.ndarray, " T"]
    residual: Float[np.ndarray, "T C"]


def judged_rows(monitor: Monitor, log: Log) -> Judgement:
    """Scores of a monitor with its limits off: nothing is excluded, so the scores do not depend on limits."""
    replayed = replay_log(monitor, log)
    return Judgement(np.asarray(replayed.scores[0])[:, 0], np.asarray(replayed.residual))


def left_of_spikes(drive: Drive, spiked: Log, there: Judgement, clean: Judgement) -> float:
    """Median share of a spike that remains in the residual, that is, that the model does not copy."""
    spike = spiked.value - drive.rest.value
    left = np.abs(there.residual - clean.residual)
    return float(np.median(left[spike != 0] / np.abs(spike[spike != 0])))
