"""Missing sensors and holes in the log, sample by sample."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from sensorfault.events.event import Event
from sensorfault.runtime.event_context import EventContext

GAP_S = 1.0  # a shorter hole in the log is the recorder's jitter, not a fault

_Name = tuple[str, str | None]  # a sensor, and one channel of it or all


@dataclass(frozen=True)
class _Silent:
    start_s: float  # when the next value should have come
    last_s: float  # the last sample without one
    lasts_s: float
    allowed_s: float


class SilenceTracker:
    """The silences that are open, and those that each sample ends.

    A sensor is silent when all its channels are; a channel, when its sensor still sends others.
    """

    def __init__(self, context: EventContext) -> None:
        self._context = context
        self._columns = context.columns
        self._longest = max(GAP_S, float(context.silent_after_s.max()))
        self._open: dict[_Name, _Silent] = {}
        self._first: float | None = None
        self._holes: list[tuple[float, float]] = []  # (end, length) of those that may lie in a silence [s]

    def push(self, time: float, gap_s: float, silence: Float[np.ndarray, " C"]) -> list[Event]:
        """The silences that this sample ended, and the hole in the log before it."""
        missing = self._missing(time, self._without_holes(time, gap_s, silence))
        over = [name for name in self._open if name not in missing]
        ended = [self._event(name, self._open.pop(name), ended=True) for name in over]
        for name, one in missing.items():
            begun = self._open.get(name, one)
            self._open[name] = replace(one, start_s=begun.start_s, allowed_s=begun.allowed_s)
        if gap_s > self._longest:
            gap = time - gap_s, time, "sensor", None, None, "missing", gap_s, self._longest, self._context.method
            ended.append(Event(*gap))
        return ended

    def open(self) -> list[Event]:
        """The silences that go on: `end_s` is None."""
        return [self._event(name, one, ended=False) for name, one in self._open.items()]

    def busy(self) -> bool:
        """Whether a silence is open."""
        return bool(self._open)

    def _without_holes(self, time: float, gap_s: float, silence: Float[np.ndarray, " C"]) -> Float[np.ndarray, " C"]:
        """How long each channel has been silent while the log was being recorded [s]."""
        if self._first is None:
            self._first = time
        silence = np.minimum(silence, time - self._first)
        if gap_s > self._context.hole_s:
            self._holes.append((time, gap_s))
        self._holes = [hole for hole in self._holes if hole[0] > time - silence.max()]
        for end, length in self._holes:
            # No tick came in a hole: a channel whose last value came before it was not silent in it.
            silence = silence - np.where(time - silence < end, length, 0.0)
        return silence

    def _missing(self, time: float, silence: Float[np.ndarray, " C"]) -> dict[_Name, _Silent]:
        silent = silence > self._context.silent_after_s
        missing: dict[_Name, _Silent] = {}
        if not silent.any():
            return missing
        for sensor, columns in self._columns.items():
            if silent[columns].all():
                missing[sensor, None] = self._silent(time, columns, silence)
                continue
            for c in columns:
                if silent[c]:
                    missing[sensor, self._context.channel[c]] = self._silent(time, [c], silence)
        return missing

    def _silent(self, time: float, columns: list[int], silence: Float[np.ndarray, " C"]) -> _Silent:
        """From when the first of them should have sent a value again."""
        first = columns[int(np.argmin(silence[columns]))]
        lasts_s, allowed_s = float(silence[first]), float(self._context.silent_after_s[first])
        return _Silent(float(time - silence[first] + self._context.period_s[first]), time, lasts_s, allowed_s)

    def _event(self, name: _Name, one: _Silent, ended: bool) -> Event:
        end_s, (sensor, channel) = one.last_s if ended else None, name
        score, limit, method = one.lasts_s, one.allowed_s, self._context.method
        return Event(one.start_s, end_s, "sensor", sensor, channel, "missing", score, limit, method)
