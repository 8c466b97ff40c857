"""What accuses one device by itself, and how runs of values beyond a limit become findings."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.relations.signals import Signal


@dataclass(frozen=True)
class Finding:
    """One device is wrong from `start_s` to `end_s`; `value` beyond `limit`, as `test` says."""

    device: str
    start_s: float
    end_s: float
    test: str
    value: float
    limit: float
    kind: str = "unknown"
    lasting: bool = False  # nothing is compared with the device from then on


def device_of(signal: Signal) -> str:
    """The device that is accused for a signal."""
    return signal.key.partition(".")[0]


def runs(time: Float[np.ndarray, " n"], bad: Bool[np.ndarray, " n"], join_s: float) -> Iterator[tuple[int, int]]:
    """First and last index of each run of bad ones, joined over short breaks."""
    index = np.flatnonzero(bad)
    if not len(index):
        return
    cut = np.flatnonzero(np.diff(time[index]) > join_s)
    yield from zip(index[np.r_[0, cut + 1]].tolist(), index[np.r_[cut, len(index) - 1]].tolist(), strict=True)


def worst(
    device: str,
    time: np.ndarray,
    value: np.ndarray,
    limit: float,
    join_s: float,
    test: str,
    half_s: float = 0.0,
    lasting: bool = False,
) -> Iterator[Finding]:
    """One finding for each run of values beyond a limit. `lasting` ones are offsets."""
    for first, last in runs(time, np.abs(value) > limit, join_s):
        peak = value[first : last + 1][np.argmax(np.abs(value[first : last + 1]))]
        start_s, end_s = float(time[first]) - half_s, float(time[last]) + half_s
        kind = "offset" if lasting else "unknown"
        yield Finding(device, start_s, end_s, test, float(peak), limit, kind, lasting)
