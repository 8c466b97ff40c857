"""Faults from verdicts, sample by sample: who is accused, from when to when, and how clearly."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from sensorfault.core.verdicts import FAULT
from sensorfault.events.classifier import FaultClassifier
from sensorfault.events.event import Event
from sensorfault.runtime.event_context import Accused, EventContext
from sensorfault.runtime.joint_events import Found, joined
from sensorfault.runtime.model import MOTION
from sensorfault.runtime.runners import StepResult

QUIET_S = 2.0  # alarms of one channel closer than this are one event


@dataclass
class _Open:
    """A fault that may go on; its peak is that of the test that exceeded its limit most."""

    start_s: float
    last_s: float  # of the last accusation
    classifier: FaultClassifier = field(default_factory=FaultClassifier)
    since: list[tuple[float, float, float]] = field(default_factory=list)  # measurements after the last accusation
    score: float = float("nan")
    limit: float = float("nan")


class FaultTracker:
    """The faults that are open, and those that each sample ends."""

    def __init__(self, context: EventContext) -> None:
        self._context = context
        self._open: dict[Accused, _Open] = {}
        self._may_accuse: dict[Accused, np.ndarray] = {}

    def push(self, time: float, measured: Float[np.ndarray, " C"], now: StepResult) -> list[Event]:
        """The faults that this sample ended."""
        over = [accused for accused, one in self._open.items() if time - one.last_s > QUIET_S]
        ended = [self._found(accused, self._open.pop(accused), ended=True) for accused in over]
        faulty = _accused(now)
        for accused in faulty:
            one = self._open.setdefault(accused, _Open(time, time))
            one.last_s = time
            self._raise_peak(accused, one, now)
        self._classify(time, measured, now, faulty)
        return joined(ended, self._context)

    def open(self) -> list[Event]:
        """The faults that go on: `end_s` is None."""
        return joined([self._found(accused, one, ended=False) for accused, one in self._open.items()], self._context)

    def busy(self) -> bool:
        """Whether a fault is open."""
        return bool(self._open)

    def _classify(self, time: float, measured: Float[np.ndarray, " C"], now: StepResult, faulty: list[Accused]) -> None:
        """Give each open fault of a channel its measurements; those after its last accusation do not count."""
        for c, one in self._open.items():
            if not isinstance(c, int) or not now.valid[c]:
                continue
            one.since.append((time, float(measured[c]), float(now.residual[c])))
            if c in faulty:
                one.classifier.take(one.since)
                one.since.clear()

    def _raise_peak(self, accused: Accused, one: _Open, now: StepResult) -> None:
        """Keep the score and limit of the test that exceeded its limit most, of those that may accuse this one."""
        if accused not in self._may_accuse:
            self._may_accuse[accused] = np.array(self._context.may_accuse(accused))
        over = self._may_accuse[accused] & (now.score > now.limit)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            excess = np.where(over, now.score / np.maximum(now.limit, 1e-300), -np.inf)
        k = int(np.argmax(excess))
        old = one.score / max(one.limit, 1e-300) if np.isfinite(one.score) else -np.inf
        if excess[k] > old:
            one.score, one.limit = float(now.score[k]), float(now.limit[k])

    def _found(self, accused: Accused, one: _Open, ended: bool) -> Found:
        context, end_s = self._context, one.last_s if ended else None
        score, limit = (x if np.isfinite(x) else None for x in (one.score, one.limit))
        if not isinstance(accused, int):
            subject = "motion" if accused == MOTION else "sensor"
            event = Event(one.start_s, end_s, subject, None, None, "unknown", score, limit, context.method)
        else:
            kind = one.classifier.kind(float(context.period_s[accused]), float(context.sigma[accused]))
            names = context.sensor[accused], context.channel[accused]
            event = Event(one.start_s, end_s, "sensor", *names, kind, score, limit, context.method)
        return Found(accused, one.last_s, one.classifier.size, event)


def _accused(now: StepResult) -> list[Accused]:
    accused: list[Accused] = list(np.flatnonzero(now.channel == FAULT).tolist())
    if now.sample == FAULT and not accused:
        accused = [None]
    if now.motion == FAULT:
        accused.append(MOTION)
    return accused
