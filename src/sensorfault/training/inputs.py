"""The inputs of a predictor: columns of a healthy log, held between measurements and scaled."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Log

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
