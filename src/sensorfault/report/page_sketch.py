"""What the page draws of a log: some points of each line and the runs of each verdict, gathered part by part."""

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.events.event import MOTION, Event
from sensorfault.events.event import UNKNOWN as UNKNOWN_WHICH
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.report.page_lines import Span, near
from sensorfault.report.page_strokes import Drawn, Lane, Tested
from sensorfault.runtime.result import Detection

POINTS = 300_000  # of all lines together, and at most as many again around the events: 3 to 7 MB
BANDS = 1500  # of a sensor's verdicts


class Sketch:
    """A detection as the page draws it, gathered part by part. A whole log is one part.

    `log` is the first part: channels, sensors, name and clock. The other attributes are of all parts.
    """

    log: Log

    def __init__(self, points: int = POINTS) -> None:
        self.rows, self._points = 0, points
        self.events: tuple[Event, ...] = ()
        self.tests: dict[tuple[str, str | None], Tested] = {}
        self._unattributed = self._motion = False

    @classmethod
    def of(cls, detection: Detection, points: int = POINTS) -> "Sketch":
        """The sketch of a log that was judged whole. `points`: of all lines together.

        Raises:
            RowsNotKept: it was judged in parts.
        """
        sketch = cls(points)
        sketch.take(detection)
        return sketch

    def _begin(self, first: Detection) -> None:
        self.log, self.method, self.watched = first.log, first.method, first.watched
        self.start_s = self.end_s = float(first.log.time[0]) if len(first.log) else 0.0
        self.period_s = first.log.period_s
        self.channels = [Drawn() for _ in first.log.channels]
        self._lanes = {name: Lane() for name in (*(s.name for s in first.log.sensors), UNKNOWN_WHICH, MOTION)}

    @property
    def span(self) -> Span:
        """The time from the first row to the last [s], never empty."""
        if self.end_s > self.start_s:
            return self.start_s, self.end_s
        return (self.start_s - 0.5, self.start_s + 0.5) if self.rows else (0.0, 1.0)

    @property
    def lanes(self) -> list[tuple[str, Lane]]:
        """The verdicts on each sensor; on the whole row, where no sensor could be isolated; on the motion.

        What is at fault comes first, what was never judged last.
        """
        shown = {UNKNOWN_WHICH: self._unattributed, MOTION: self._motion}
        lanes = [(name, lane) for name, lane in self._lanes.items() if shown.get(name, True)]
        return sorted(lanes, key=lambda one: (FAULT not in one[1].verdict, set(one[1].verdict) <= {UNKNOWN}))

    def take(self, part: Detection, share: float = 1.0) -> None:
        """Add the next part, which is `share` of the log, and take its events, which are all so far."""
        part = part.received
        if not hasattr(self, "log"):
            self._begin(part)
        self.rows, self.events = self.rows + len(part.log), part.events
        if not len(part.log):
            return
        self.end_s = float(part.log.time[-1])
        lines = len(part.log.channels) + len(part.traces)
        points = max(8, round(share * max(1000, self._points // max(1, lines))))
        keep = near(part.log.time, self._spans(part.log), points)
        for column, drawn in enumerate(self.channels):
            self._draw(drawn, part, column, keep, points)
        for trace in part.traces:
            test = self.tests.setdefault((trace.name, trace.channel), Tested(trace))
            test.add(part.log.time, trace, keep, points)
        self._judge(part, max(8, round(share * BANDS)))

    def _spans(self, log: Log) -> list[Span]:
        """The events that overlap this part or ended shortly before it."""
        first, last = float(log.time[0]), float(log.time[-1])
        spans = [(event.start_s, last if event.end_s is None else event.end_s) for event in self.events]
        return [span for span in spans if span[1] >= first - 2 and span[0] <= last + 2]

    def _draw(self, drawn: Drawn, part: Detection, column: int, keep: Bool[np.ndarray, " T"], points: int) -> None:
        log, unit = part.log, part.log.channels[column].unit
        value, old = from_si(log.value[:, column], unit), stale(log, column, drawn.fresh_s)
        drawn.measured.add(log.time, np.where(old, np.nan, value), keep, points)
        drawn.held.add(log.time, np.where(old, value, np.nan), keep, points)
        drawn.stand_in.add(log.time, from_si(replaced(part, column), unit), keep, points)
        at = log.time[log.fresh[:, column]]
        drawn.fresh_s = float(at[-1]) if at.size else drawn.fresh_s

    def _judge(self, part: Detection, most: int) -> None:
        time = part.log.time
        for i, sensor in enumerate(part.log.sensors):
            self._lanes[sensor.name].add(time, part.sensor[:, i], most)
        unattributed = (part.sample == FAULT) & (part.sensor.max(axis=1, initial=OK) < FAULT)
        self._lanes[UNKNOWN_WHICH].add(time, np.where(unattributed, FAULT, OK).astype(np.int8), most)
        self._lanes[MOTION].add(time, part.motion, most)
        self._unattributed |= bool(unattributed.any())
        self._motion |= bool((part.motion != UNKNOWN).any())


def stale(log: Log, column: int, fresh_s: float = -np.inf) -> Bool[np.ndarray, " T"]:
    """Rows in which a value is held for longer than the sensor's own period: the last measurement, repeated.

    `fresh_s`: time of the last measurement before this part [s].
    """
    fresh = log.fresh[:, column]
    last: Float[np.ndarray, " T"] = np.maximum.accumulate(np.where(fresh, log.time, fresh_s))
    period = next(s.period_s for s in log.sensors if s.name == log.channels[column].sensor)
    held: Bool[np.ndarray, " T"] = ~fresh & (log.time - last > 2.5 * np.fmax(period, log.period_s))
    return held


def replaced(detection: Detection, column: int) -> Float[np.ndarray, " T"]:
    """The stand-in where the channel was faulty or missing, and one row on either side to join it to the signal."""
    value, repaired = detection.log.value[:, column], detection.repaired[:, column]
    mask = (detection.channel[:, column] == FAULT) | (~np.isfinite(value) & np.isfinite(repaired))
    wide = mask.copy()
    wide[:-1] |= mask[1:]
    wide[1:] |= mask[:-1]
    stand_in: Float[np.ndarray, " T"] = np.where(wide, repaired, np.nan)
    return stand_in
