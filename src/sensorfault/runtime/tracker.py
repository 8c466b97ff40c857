"""Fault events from verdicts, sample by sample, for a log and live alike."""

import numpy as np
from jaxtyping import Float

from sensorfault.events.event import Event
from sensorfault.runtime.event_context import EventContext
from sensorfault.runtime.fault_tracker import FaultTracker
from sensorfault.runtime.runners import StepResult
from sensorfault.runtime.silence_tracker import SilenceTracker


class Tracker:
    """Turns one row after the other into events. A healthy row while nothing is open changes nothing."""

    def __init__(self, context: EventContext) -> None:
        self._faults = FaultTracker(context)
        self._silences = SilenceTracker(context)

    def push(self, time: float, gap_s: float, measured: Float[np.ndarray, " C"], now: StepResult) -> list[Event]:
        """The events that this sample brought to an end.

        `time` [s]; `gap_s` since the sample before; `measured` as it came [SI]; `now` what the monitor said of it.
        """
        return self._faults.push(time, measured, now) + self._silences.push(time, gap_s, now.silence)

    def open(self) -> list[Event]:
        """What goes on: `end_s` is None."""
        return sorted(self._faults.open() + self._silences.open(), key=lambda event: event.start_s)

    def busy(self) -> bool:
        """Whether an event is open, so that the next row matters whatever its verdict."""
        return self._faults.busy() or self._silences.busy()
