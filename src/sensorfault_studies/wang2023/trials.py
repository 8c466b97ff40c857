"""Faults of one satellite, and their detection."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault_studies.wang2023.campaign import Flown

ONSETS, LASTS = (100, 200, 300), 80  # epochs
LOST_M = 1000.0  # larger position errors count as this [m]


@dataclass(frozen=True)
class SatelliteFault:
    """A step [m] or a ramp [m/s] of one satellite, LASTS epochs long."""

    kind: str
    size: float

    @property
    def shape(self) -> Float[np.ndarray, " L"]:
        """The error that it adds, by epoch [m]."""
        return self.size * (np.arange(LASTS) if self.kind == "ramp" else np.ones(LASTS))


FAULTS = (
    *(SatelliteFault("step", size) for size in (5.0, 10.0, 15.0, 20.0, 30.0)),
    *(SatelliteFault("ramp", size) for size in (0.1, 0.25, 0.5, 1.0, 2.0)),
)


def trials(error: Float[np.ndarray, "N E S"], fault: SatelliteFault) -> Float[np.ndarray, "M E S"]:
    """Every run with a fault of every satellite from every onset: M = N × onsets × S."""
    satellites = error.shape[2]
    every = np.repeat(error, len(ONSETS) * satellites, axis=0)
    for m, (onset, satellite) in enumerate(_who(len(error), satellites)):
        every[m, onset : onset + LASTS, satellite] += fault.shape
    return every


def _who(runs: int, satellites: int) -> Sequence[tuple[int, int]]:
    return [(onset, satellite) for _ in range(runs) for onset in ONSETS for satellite in range(satellites)]


def outcome(result: Flown, runs: int) -> list[dict[str, float]]:
    """Numbers of each run, over satellites and onsets.

    `detection_rate`: share of the fault's epochs in which the satellite is flagged. `delay_s`: until it is first
    flagged, at most the fault's length. `wrong_exclusions`: share of the epochs in which another satellite is flagged.
    `hrmse_m`: RMS horizontal position error during the fault.
    """
    who = _who(runs, result.flagged.shape[2])
    rows = []
    for m, (onset, satellite) in enumerate(who):
        flagged = result.flagged[m, onset : onset + LASTS]
        mine = flagged[:, satellite]
        others = np.delete(flagged, satellite, axis=1).any(axis=1)
        delay = float(np.argmax(mine)) if mine.any() else float(LASTS)
        square = np.mean(np.minimum(result.off_m[m, onset : onset + LASTS], LOST_M) ** 2)
        rows.append((mine.mean(), delay, others.mean(), square))
    each = np.array(rows, float).reshape(runs, -1, 4).mean(axis=1)
    return [
        {"detection_rate": d, "delay_s": s, "wrong_exclusions": w, "hrmse_m": float(np.sqrt(q))}
        for d, s, w, q in each.tolist()
    ]
