"""Fault events from verdicts, sample by sample, for a log and live alike."""

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from sensorfault.core.types import FAULT
from sensorfault.events.classifier import FaultClassifier
from sensorfault.events.event import Event
from sensorfault.runtime.model import MOTION, TOGETHER
from sensorfault.runtime.runners import StepResult

QUIET_S = 2.0  # alarms of one channel closer than this are one event
GAP_S = 1.0  # a shorter hole in the log is the recorder's jitter, not a fault


@dataclass(frozen=True)
class EventContext:
    """What the tracker must know of a model, channel by channel.

    `tests[k]`: the columns that test k accuses, one or all of them together; None for a test that finds out whom,
    MOTION for one of the vehicle. `tick_s`: the clock; where it stands still for longer than three ticks there is a
    hole in the log, which is nobody's silence.
    """

    method: str
    sensor: tuple[str, ...]
    channel: tuple[str, ...]
    period_s: Float[np.ndarray, " C"]
    silent_after_s: Float[np.ndarray, " C"]
    sigma: Float[np.ndarray, " C"]  # of the healthy residual [SI]
    tests: tuple[tuple[int, ...] | str | None, ...]
    tick_s: float

    @property
    def hole_s(self) -> float:
        """A longer time between two samples is a hole [s]."""
        return 3.5 * self.tick_s


@dataclass
class _Open:
    start_s: float
    last_s: float
    classifier: FaultClassifier = field(default_factory=FaultClassifier)
    since: list[tuple[float, float, float]] = field(default_factory=list)  # measurements after the last accusation
    score: float = float("nan")
    limit: float = float("nan")


_Accused = int | str | None  # a channel, MOTION, or nobody known


@dataclass(frozen=True)
class _Ended:
    """A fault that is over, or told of while it goes on."""

    accused: _Accused
    open: _Open
    event: Event

    @property
    def column(self) -> int:
        """The channel accused."""
        assert isinstance(self.accused, int)
        return self.accused

    @property
    def excess(self) -> float:
        """Score over limit."""
        return (self.event.peak_score or 0.0) / (self.event.limit or 1.0)


def _about(test: tuple[int, ...] | str | None, accused: _Accused) -> bool:
    """Whether a test of Watch.tests may have accused this one."""
    if test is None:
        return accused != MOTION
    return accused == test if isinstance(test, str) else accused in test


class Tracker:
    """Turns one row after the other into events. A healthy row while nothing is open changes nothing."""

    def __init__(self, watch: EventContext) -> None:
        self._watch = watch
        self._open: dict[_Accused, _Open] = {}
        self._silent: dict[tuple[str, str | None], _Open] = {}
        self._first: float | None = None
        self._holes: list[tuple[float, float]] = []  # (end, length) of those that may lie in somebody's silence [s]
        sensors = dict.fromkeys(watch.sensor)
        self._of = {s: [c for c, owner in enumerate(watch.sensor) if owner == s] for s in sensors}
        accused = [test for test in watch.tests if isinstance(test, tuple) and len(test) > 1]
        self._groups = dict.fromkeys([*(tuple(channels) for channels in self._of.values()), *accused])

    def push(self, time: float, gap_s: float, measured: Float[np.ndarray, " C"], now: StepResult) -> list[Event]:
        """The events that this sample brought to an end.

        `time` [s]; `gap_s` since the sample before; `measured` as it came [SI]; `now` what the monitor said of it.
        """
        if self._first is None:
            self._first = time
        return self._faults(time, measured, now) + self._silences(time, gap_s, now.silence)

    def open(self) -> list[Event]:
        """What is still going on: `end_s` is None."""
        faults = self._together([_Ended(c, one, self._fault(c, one, None)) for c, one in self._open.items()])
        silent = [self._miss(name, one, None) for name, one in self._silent.items()]
        return sorted(faults + silent, key=lambda event: event.start_s)

    def busy(self) -> bool:
        """Whether an event is open, so that the next row matters whatever its verdict."""
        return bool(self._open or self._silent)

    def _faults(self, time: float, measured: Float[np.ndarray, " C"], now: StepResult) -> list[Event]:
        over = {c: one for c, one in self._open.items() if time - one.last_s > QUIET_S}
        for c in over:
            del self._open[c]
        accused: list[_Accused] = list(np.flatnonzero(now.channel == FAULT).tolist())
        if now.sample == FAULT and not accused:
            accused = [None]
        if now.motion == FAULT:
            accused.append(MOTION)
        for c in accused:
            one = self._open.setdefault(c, _Open(time, time))
            one.last_s = time
            self._peak(c, one, now)
        for c, one in self._open.items():
            if not isinstance(c, int) or not now.valid[c]:
                continue
            one.since.append((time, float(measured[c]), float(now.residual[c])))
            if c in accused:
                one.classifier.take(one.since)
                one.since.clear()
        return self._together([_Ended(c, one, self._fault(c, one, one.last_s)) for c, one in over.items()])

    def _together(self, found: list[_Ended]) -> list[Event]:
        """One event for channels that a test accuses together, and for a sensor of which all showed the same kind."""
        result = [ended.event for ended in found]
        for group in self._groups:
            mine = [ended for ended in found if ended.accused in group]
            sensor = len(group) == len(self._of[self._watch.sensor[group[0]]])
            same = sensor and len({ended.event.kind for ended in mine}) == 1
            alike = group in self._watch.tests and len({(e.event.start_s, e.open.last_s) for e in mine}) == 1
            if len(mine) == len(group) > 1 and (alike or same):
                result = [event for event in result if not any(event is ended.event for ended in mine)]
                result.append(self._one(mine, sensor))
        return result

    def _one(self, mine: list[_Ended], sensor: bool) -> Event:
        """The event of several channels of one sensor, or of all of it: its kind is that of the clearest."""
        worst = max(mine, key=lambda ended: ended.excess).event
        clearest = max(mine, key=lambda ended: ended.open.classifier.size / float(self._watch.sigma[ended.column]))
        return replace(
            worst,
            start_s=min(ended.event.start_s for ended in mine),
            channel=None if sensor else TOGETHER.join(self._watch.channel[ended.column] for ended in mine),
            kind="frozen" if any(ended.event.kind == "frozen" for ended in mine) else clearest.event.kind,
        )

    def _peak(self, c: _Accused, one: _Open, now: StepResult) -> None:
        """The largest excess of a joint test, or of one on this channel; of the motion's own tests if it is that."""
        mine = np.array([_about(test, c) for test in self._watch.tests])
        with np.errstate(divide="ignore", invalid="ignore"):
            excess = np.where(mine & (now.score > now.limit), now.score / np.maximum(now.limit, 1e-300), -np.inf)
        k = int(np.argmax(excess))
        old = one.score / max(one.limit, 1e-300) if np.isfinite(one.score) else -np.inf
        if excess[k] > old:
            one.score, one.limit = float(now.score[k]), float(now.limit[k])

    def _fault(self, c: _Accused, one: _Open, end_s: float | None) -> Event:
        watch = self._watch
        score, limit = (x if np.isfinite(x) else None for x in (one.score, one.limit))
        if not isinstance(c, int):
            subject = "motion" if c == MOTION else "sensor"
            return Event(one.start_s, end_s, subject, None, None, "unknown", score, limit, watch.method)
        kind = one.classifier.kind(float(watch.period_s[c]), float(watch.sigma[c]))
        sensor, channel = watch.sensor[c], watch.channel[c]
        return Event(one.start_s, end_s, "sensor", sensor, channel, kind, score, limit, watch.method)

    def _silences(self, time: float, gap_s: float, silence: Float[np.ndarray, " C"]) -> list[Event]:
        """A sensor is silent when all its channels are; a channel, when its sensor still speaks."""
        assert self._first is not None
        silence = np.minimum(silence, time - self._first)
        if gap_s > self._watch.hole_s:
            self._holes.append((time, gap_s))
        self._holes = [hole for hole in self._holes if hole[0] > time - silence.max()]
        for end, length in self._holes:
            # No tick came in a hole: who was heard before it was not silent in it.
            silence = silence - np.where(time - silence < end, length, 0.0)
        silent = silence > self._watch.silent_after_s
        missing: dict[tuple[str, str | None], tuple[float, float, float]] = {}
        if silent.any():
            for sensor, channels in self._of.items():
                if silent[channels].all():
                    missing[sensor, None] = self._since(time, channels, silence)
                else:
                    for c in channels:
                        if silent[c]:
                            missing[sensor, self._watch.channel[c]] = self._since(time, [c], silence)
        ended = []
        for name in [name for name in self._silent if name not in missing]:
            one = self._silent.pop(name)
            ended.append(self._miss(name, one, one.last_s))
        for name, (since, lasts, allowed) in missing.items():
            one = self._silent.setdefault(name, _Open(since, time, limit=allowed))
            one.last_s, one.score = time, lasts
        longest = max(GAP_S, float(self._watch.silent_after_s.max()))
        if gap_s > longest:
            gap = time - gap_s, time, "sensor", None, None, "missing", gap_s, longest, self._watch.method
            ended.append(Event(*gap))
        return ended

    def _since(self, now: float, channels: list[int], silence: Float[np.ndarray, " C"]) -> tuple[float, float, float]:
        """When the first of them should have spoken again; how long it has been silent, and may be."""
        first = channels[int(np.argmin(silence[channels]))]
        start = now - silence[first] + self._watch.period_s[first]
        return float(start), float(silence[first]), float(self._watch.silent_after_s[first])

    def _miss(self, name: tuple[str, str | None], one: _Open, end_s: float | None) -> Event:
        sensor, channel = name
        return Event(one.start_s, end_s, "sensor", sensor, channel, "missing", one.score, one.limit, self._watch.method)
