"""One log through a model, part after part."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from sensorfault.core.verdicts import FAULT
from sensorfault.events.clock_events import by_onset, clock_events
from sensorfault.events.event import Event
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.logs.table import Log
from sensorfault.runtime.extractor import EventExtractor
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import Progress, Replayed, replay_on
from sensorfault.runtime.result import Detection, Trace

See = Callable[[Detection, float], None]  # a part that was judged, with all events so far; its share of what is judged


class Detector:
    """Judges consecutive parts of one log. Between two parts it keeps the monitor's state and the open events.

    Memory grows with the largest part, not with the log.
    """

    def __init__(self, model: Model, see: See | None = None) -> None:
        self.model = model
        self._see = see
        self._state = model.monitor.init()
        self._extractor = EventExtractor(model)
        self._jumps: tuple[Event, ...] = ()  # of the clock
        self._parts = self._rows = 0
        self._first: Log | None = None  # the first row
        self._last: tuple[Log, Replayed] | None = None  # the last part

    def take(self, part: Log, share: float = 1.0, progress: Progress | None = None) -> None:
        """Judge the next part.

        `share`: how much of all that is judged it is. `progress` gets the share of the part that is done.

        Raises:
            LogError: the part is empty, lacks a channel of the model, or is sampled at another rate.
        """
        log = self.model.take(part)
        self._state, result = replay_on(self.model.monitor, self._state, log, progress)
        self._extractor.take(log, result)
        self._jumps += clock_events(log, self.model.method)
        self._last = log, result
        if self._first is None:
            self._first = _row(log, 0)
        self._parts += 1
        self._rows += len(log)
        if self._see is not None:
            self._see(self._part(), share)

    def found(self, said: ReadingNotes | None = None, fitted_on_s: tuple[float, float] | None = None) -> Detection:
        """The result so far; with all rows if there was only one part.

        `said`: what reading the log found. `fitted_on_s`: which beginning of it the model was fitted on [s].
        """
        assert self._first is not None
        detection = replace(self._part(), fitted_on_s=fitted_on_s)
        if said is not None:
            notes = tuple(dict.fromkeys((*said.notes, *detection.log.notes)))
            detection = replace(detection, log=replace(detection.log, notes=notes, damage=said.damage))
        if self._parts == 1:
            return detection
        ends = joined([self._first, _row(detection.log, -1)])
        return detection.without_rows(ends, self._rows)

    def _part(self) -> Detection:
        """The last part, with all events so far."""
        assert self._last is not None
        return detected(self.model, *self._last, by_onset(self._extractor.events, self._jumps))


def joined(parts: list[Log]) -> Log:
    """Consecutive parts of a log as one; a single one as it is."""
    if len(parts) == 1:
        return parts[0]
    return replace(
        parts[-1],
        time=np.concatenate([part.time for part in parts]),
        value=np.concatenate([part.value for part in parts]),
        fresh=np.concatenate([part.fresh for part in parts]),
    )


def _row(log: Log, i: int) -> Log:
    return replace(log, time=log.time[[i]], value=log.value[[i]], fresh=log.fresh[[i]])


def detected(model: Model, log: Log, result: Replayed, events: Iterable[Event]) -> Detection:
    """The detection of a log that `model.take` returned, from the replay of it."""
    doubtful = np.isnan(log.value) | log.fresh | (np.asarray(result.channel) == FAULT)
    lost = ~np.asarray(result.believed) & doubtful
    return Detection(
        log=log,
        method=model.method,
        watched=model.watched,
        channel=np.asarray(result.channel),
        sensor=np.asarray(result.sensor),
        sample=np.asarray(result.sample),
        motion=np.asarray(result.motion),
        repaired=np.where(lost, np.nan, np.asarray(result.value)),
        traces=_traces(model, result),
        events=tuple(events),
        residual=np.where(np.asarray(result.valid), np.asarray(result.residual), np.nan),
        model=model,
    )


def _traces(model: Model, result: Replayed) -> tuple[Trace, ...]:
    score, limit = (np.concatenate([np.asarray(x) for x in xs], axis=1) for xs in (result.scores, result.limits))
    return tuple(
        Trace(name, channel, score[:, k], limit[:, k])
        for k, (name, channel) in enumerate(model.tests)
        if np.isfinite(score[:, k]).any()
    )
