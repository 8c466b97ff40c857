"""Jumps of a clock: when it was set, and how far."""

from collections.abc import Iterable
from dataclasses import dataclass

DAY_S = 86_400.0
_TOGETHER_S = 3.0  # tables whose clocks jump alike within this have one clock


@dataclass(frozen=True)
class Jump:
    """`time_s`: of the first row after it, on the mended clock [s]. `step_s`: what the clock jumped by, < 0 if back.

    `clock`: the time column.
    """

    time_s: float
    step_s: float
    clock: str

    @property
    def said(self) -> str:
        """`the clock 'time_s' jumps back by 7168 days`."""
        return f"the clock '{self.clock}' jumps {'back' if self.step_s < 0 else 'ahead'} by {lasting(self.step_s)}"


def lasting(length_s: float) -> str:
    """A length of time in seconds, or in days if it is long."""
    days = abs(length_s) / DAY_S
    return f"{abs(length_s):.6g} s" if days < 0.5 else f"{days:.4g} days"


def distinct(jumps: Iterable[Jump]) -> tuple[Jump, ...]:
    """Each jump once, by time: those of several tables that have one clock are one."""
    found: list[Jump] = []
    for jump in sorted(jumps, key=lambda one: one.time_s):
        if not any(_alike(jump, other) for other in found):
            found.append(jump)
    return tuple(found)


def _alike(one: Jump, other: Jump) -> bool:
    near = max(abs(one.time_s - other.time_s), abs(one.step_s - other.step_s))
    return near < _TOGETHER_S and one.step_s * other.step_s > 0
