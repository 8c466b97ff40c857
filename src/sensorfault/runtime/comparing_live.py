"""The default method on a running vehicle: every second, what is new is compared."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float, Int8

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.events.event import Event
from sensorfault.logs.table import Log
from sensorfault.relations.events import events_of
from sensorfault.relations.judge import Judged
from sensorfault.relations.running import KEPT_S, Running
from sensorfault.runtime.compared import Comparison, tested_sensors

EVERY_S = 1.0


class ComparingLive:
    """Keeps the last samples; every second of their clock it compares them. Verdicts stand until the next comparison.

    Args:
        comparison: fitted, so that it knows the channels and their limits.
    """

    def __init__(self, comparison: Comparison) -> None:
        assert comparison.learned is not None
        self._comparison = comparison
        self._names = [sensor.name for sensor in comparison.sensors]
        self._owner = np.array([self._names.index(channel.sensor) for channel in comparison.channels])
        self._rows = 0
        width = len(comparison.channels)
        self._time: Float[np.ndarray, " N"] = np.empty(1024)
        self._value: Float[np.ndarray, "N C"] = np.empty((1024, width))
        self._fresh: Bool[np.ndarray, "N C"] = np.empty((1024, width), bool)
        self._compared_s = -np.inf
        self._new = 0  # the first row that was not compared yet
        self._running = Running(comparison.learned)
        self._going: list[Event] = []
        self.sensor: Int8[np.ndarray, " S"] = np.full(len(self._names), UNKNOWN, np.int8)
        self.sample = UNKNOWN

    def push(self, time: float, value: Float[np.ndarray, " C"], fresh: Bool[np.ndarray, " C"]) -> list[Event]:
        """Take one sample; the events that ended."""
        if self._rows == len(self._time):
            self._make_room(time)
        self._time[self._rows], self._value[self._rows], self._fresh[self._rows] = time, value, fresh
        self._rows += 1
        if time - self._compared_s < EVERY_S:
            return []
        self._compared_s = time
        return self._compare()

    def open(self) -> list[Event]:
        """The events that go on."""
        return list(self._going)

    @property
    def channel(self) -> Int8[np.ndarray, " C"]:
        """The verdict on each channel: that of its sensor."""
        return np.asarray(self.sensor[self._owner])

    def _make_room(self, time: float) -> None:
        """Drop what is older than what is kept; double the room if that is not enough."""
        first = int(np.searchsorted(self._time[: self._rows], time - KEPT_S))
        size = max(len(self._time), 2 * (self._rows - first))
        for name in ("_time", "_value", "_fresh"):
            old = getattr(self, name)
            new = np.empty((size, *old.shape[1:]), old.dtype)
            new[: self._rows - first] = old[first : self._rows]
            setattr(self, name, new)
        self._rows -= first
        self._new -= first

    def _compare(self) -> list[Event]:
        judged = self._running.more(self._log(self._new))
        if judged is None:
            first = int(np.searchsorted(self._time[: self._rows], self._compared_s - KEPT_S))
            judged = self._running.whole(self._log(first))
        self._new = self._rows
        found = events_of(judged, self._compared_s)
        self._set_verdicts(judged, [event for event in found if event.end_s is None])
        return self._update(list(found))

    def _log(self, first: int) -> Log:
        """The rows from the first on."""
        rows = slice(first, self._rows)
        return Log(
            self._time[rows].copy(),
            self._value[rows].copy(),
            self._fresh[rows] & np.isfinite(self._value[rows]),
            self._comparison.channels,
            self._comparison.sensors,
            "live",
        )

    def _set_verdicts(self, judged: Judged, going: list[Event]) -> None:
        tested = tested_sensors(np.array([self._compared_s]), judged, self._names)[0]
        self.sensor = np.where(tested, OK, UNKNOWN).astype(np.int8)
        for event in going:
            if event.sensor in self._names:
                self.sensor[self._names.index(event.sensor)] = FAULT
        self.sample = FAULT if going else OK if tested.any() else UNKNOWN

    def _update(self, found: list[Event]) -> list[Event]:
        """Take over what goes on with its first start; return what has ended since the last comparison."""
        ended: list[Event] = []
        before, self._going = self._going, []
        for event in found:
            known = next((one for one in before if one.sensor == event.sensor and _meet(one, event)), None)
            if event.end_s is None:
                self._going.append(
                    event if known is None else replace(event, start_s=min(known.start_s, event.start_s))
                )
            elif known is not None or event.end_s > self._compared_s - 2 * EVERY_S:
                start_s = event.start_s if known is None else min(known.start_s, event.start_s)
                ended.append(replace(event, start_s=start_s))
            if known is not None:
                before.remove(known)
        ended += [replace(one, end_s=self._compared_s - EVERY_S) for one in before]
        return ended


def _meet(known: Event, event: Event) -> bool:
    """Whether an event of the same sensor is the known one, which goes on or ended after that began."""
    return event.end_s is None or event.end_s >= known.start_s
