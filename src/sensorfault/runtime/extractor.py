"""Fault events from the verdicts on a log, or on its consecutive parts."""

from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.verdicts import FAULT
from sensorfault.events.event import Event
from sensorfault.logs.table import Log
from sensorfault.runtime.event_context import EventContext
from sensorfault.runtime.fault_tracker import QUIET_S
from sensorfault.runtime.model import MOTION, TOGETHER, Model
from sensorfault.runtime.replay import Replayed
from sensorfault.runtime.runners import StepResult
from sensorfault.runtime.tracker import Tracker


def context_of(model: Model) -> EventContext:
    """The part of a model that a tracker needs."""
    paths = [channel.path for channel in model.channels]
    return EventContext(
        model.method,
        tuple(channel.sensor for channel in model.channels),
        tuple(channel.name for channel in model.channels),
        model.period_s,
        model.silent_after_s,
        np.asarray(model.sigma),
        tuple(_examined(path, paths) for _, path in model.tests),
        model.tick_s,
    )


def _examined(path: str | None, paths: list[str]) -> tuple[int, ...] | str | None:
    return path if path is None or path == MOTION else tuple(paths.index(one) for one in path.split(TOGETHER))


class EventExtractor:
    """Collects the events of consecutive parts of one log."""

    def __init__(self, model: Model) -> None:
        self._watch = context_of(model)
        self._tracker = Tracker(self._watch)
        self._ended: list[Event] = []
        self._before_s = float("nan")  # time of the last row of the previous part
        self._marked_s = -np.inf  # time of the last marked row

    @property
    def events(self) -> list[Event]:
        """All events so far; ongoing ones have no end."""
        return sorted(self._ended + self._tracker.open(), key=lambda event: event.start_s)

    def take(self, log: Log, result: Replayed) -> None:
        """Add the next part, which has at least one row, and its replay."""
        first = float(log.time[0])
        gap_s = np.diff(log.time, prepend=first if np.isnan(self._before_s) else self._before_s)
        self._before_s = float(log.time[-1])
        silent = (gap_s > self._watch.hole_s) | (np.asarray(result.silence) > self._watch.silent_after_s).any(axis=1)
        marked = (np.asarray(result.sample) == FAULT) | (np.asarray(result.motion) == FAULT) | silent
        arrays = _arrays(result)
        for i in self._interesting(log.time, marked):
            now = StepResult(*(array[i] for array in arrays))
            ended = self._tracker.push(float(log.time[i]), float(gap_s[i]), log.value[i], now)
            self._ended += [event for event in ended if not _is_pause(event)]

    def _interesting(self, time: Float[np.ndarray, " T"], marked: Bool[np.ndarray, " T"]) -> Any:
        """Rows the tracker needs: the first, the marked ones, those in QUIET_S after a marked one, and one more."""
        last = np.maximum(np.maximum.accumulate(np.where(marked, time, -np.inf)), self._marked_s)
        self._marked_s = float(last[-1])
        near = time - last <= QUIET_S
        near[1:] |= near[:-1]
        near[0] = True
        return np.flatnonzero(near)


def _is_pause(event: Event) -> bool:
    """Whether nothing at all was recorded for a while: the log itself says so, once (`Log.pauses`)."""
    return event.kind == "missing" and event.sensor is None


def _arrays(result: Replayed) -> list[Any]:
    """The fields of a StepResult, stacked over time."""
    score, limit = (np.concatenate([np.asarray(x) for x in xs], axis=1) for xs in (result.scores, result.limits))
    verdicts = result.channel, result.sensor, result.sample, result.motion
    rest = result.value, result.residual, result.valid, result.silence
    return [np.asarray(column) for column in (*verdicts, score, limit, *rest)]
