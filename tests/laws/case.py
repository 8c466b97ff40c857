"""One monitor, and what the laws must know of it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import jax
import numpy as np

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Sample


def limits_learned(state: MonitorState) -> Any:
    """The states of the thresholds."""
    return [threshold for _, threshold in state.branches]


@dataclass(frozen=True, eq=False)
class Case:
    """A fitted monitor and a healthy log that it has not seen, about 400 samples; the laws do the damage.

    The monitor is warm in the second half of the log. `lie` [SI] added to one fresh value of a channel in `named` is
    named, and gated, at once. A monitor that judges the vehicle and names nobody has `moving` instead: a lie on one of
    these channels, which the motion cannot have made, is a fault of the motion at once. `back_s` after a dropout, a gap
    in the clock or a long fault the verdicts are again those of the healthy run.
    """

    name: str
    monitor: Monitor
    rows: Sample
    lie: np.ndarray
    back_s: float
    learned: Callable[[MonitorState], Any] = limits_learned  # references, thresholds, weights
    permuted: Callable[[np.ndarray], Monitor] | None = None  # the same monitor, for channels in this order
    quiet: Sample | None = None  # healthy logs with a leading axis, to count false alarms on
    named: tuple[int, ...] | None = None  # channels that a fault is laid on; all by default
    moving: tuple[int, ...] = ()  # channels whose lie is a fault of the motion
    lost: dict[int, tuple[int, ...]] = field(default_factory=dict)  # who cannot be judged while a channel is silent
    tolerance: float = 1e-10  # of floats that two runners compute
    rate: float | None = None  # ... and the rate of them that each channel was designed for

    def __post_init__(self) -> None:
        if not self.accused and not self.moving:
            raise ValueError(
                f"{self.name}: this case accuses nobody, so most laws would say nothing of it; give the channels whose "
                "lie is named (named), or those whose lie is a fault of the motion (moving)."
            )

    @property
    def block(self) -> bool:
        """Whether its samples carry a private block."""
        return bool(jax.tree.leaves(self.rows.block))

    @property
    def accused(self) -> tuple[int, ...]:
        return tuple(range(self.channels)) if self.named is None else self.named

    @property
    def channels(self) -> int:
        return len(self.monitor.owner)

    @property
    def hold_s(self) -> np.ndarray:
        """How long a verdict may stand without a new measurement [s]."""
        return np.asarray(self.monitor.hold_s)

    def __str__(self) -> str:
        return self.name
