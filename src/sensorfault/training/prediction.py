"""Training data of a predictor: the windows before each new measurement of a healthy log, as in live use."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Log
from sensorfault.training.windows import Windows

LEAST_HALF = 1e-9  # of a range that is mapped to [-1, 1] [SI]


@dataclass(frozen=True)
class Inputs:
    """The input columns of a predictor, scaled to [-1, 1]; the first `outputs` of them are predicted.

    `held`: value of each column at each tick: the last measurement, or `center` before the first one.
    """

    columns: tuple[int, ...]
    outputs: int
    angle: Bool[np.ndarray, " V"]
    center: Float[np.ndarray, " V"]
    half: Float[np.ndarray, " V"]
    held: Float[np.ndarray, "T V"]

    @classmethod
    def of(cls, log: Log, columns: tuple[int, ...], outputs: int, turning: tuple[int, ...]) -> "Inputs":
        """Scaled by the range of the log; the columns in `turning` are angles and are unwrapped first."""
        held = np.empty((len(log), len(columns)))
        center, half = np.zeros(len(columns)), np.ones(len(columns))
        for v, column in enumerate(columns):
            there = log.fresh[:, column] & np.isfinite(log.value[:, column])
            value = log.value[there, column]
            value = np.unwrap(value) if column in turning else value
            if value.size:
                center[v], half[v] = (value.max() + value.min()) / 2, max(np.ptp(value) / 2, LEAST_HALF)
            row = np.cumsum(there) - 1
            held[:, v] = np.where(row >= 0, value[np.maximum(row, 0)], center[v]) if value.size else center[v]
        angle = np.array([column in turning for column in columns])
        return cls(columns, outputs, angle, center, half, held)

    @property
    def scaled(self) -> Float[np.ndarray, "T V"]:
        """`held`, scaled to [-1, 1]."""
        x: Float[np.ndarray, "T V"] = (self.held - self.center) / self.half
        return x


def prediction_windows(
    log: Log, inputs: Inputs, length: int, gap_s: float, stale_s: Float[np.ndarray, " D"]
) -> Windows:
    """The `length` rows before each tick with a new measurement of every output, and these measurements.

    Windows with a gap in the clock above `gap_s`, or with an output older than `stale_s`, are left out.
    """
    outputs = list(inputs.columns[: inputs.outputs])
    new = log.fresh[:, outputs] & np.isfinite(log.value[:, outputs])
    last = np.where(new, log.time[:, None], -np.inf)
    known = (log.time[:, None] - np.maximum.accumulate(last, axis=0) <= stale_s).all(axis=1)
    broken = ~known | (np.diff(log.time, prepend=-np.inf) > gap_s)
    # A row may open a window after a gap, not stand further on in it.
    bad = np.concatenate([[0], np.cumsum(broken)])
    unknown = np.concatenate([[0], np.cumsum(~known)])
    at = np.flatnonzero(new.all(axis=1))
    at = at[at >= length]
    first = at - length
    whole = (bad[at + 1] == bad[first + 1]) & (unknown[first + 1] == unknown[first])
    scaled = inputs.scaled
    return Windows(scaled, first[whole], scaled[at[whole], : inputs.outputs], length)
