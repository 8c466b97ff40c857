"""The default method on a log, or on its consecutive parts: events, verdicts, and what could not be compared."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.events.clock_events import by_onset, clock_events
from sensorfault.events.event import Event
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.logs.table import SAID, Channel, Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.relations.events import METHOD, events_of, sensor_of
from sensorfault.relations.grid import EXACT_S, STEP_S
from sensorfault.relations.judge import SHORTEST_S, Judged, fitted, judge
from sensorfault.relations.limits import Learned
from sensorfault.relations.signals import RANGE_ROLE, SATELLITES, Signal
from sensorfault.runtime import show
from sensorfault.runtime.coverage import Coverage
from sensorfault.runtime.described import check, described, known, sample
from sensorfault.runtime.result import Detection, Trace

NO_LEVELS = frozenset({"attitude", "gnss.course"})
REASONS_SHOWN = 3
HELD_S = 1.0
OVERLAP_S = 70.0  # a part is judged with the end of the part before it, so that the longest window spans the seam


class NothingToCompare(LogError):
    """No two sensors of a log say the same.

    `alone`: what checking each by itself found, if that was possible. `inertial`: whether it has an inertial unit, or
    no sensor that is known at all, so that a method for single channels may be tried.
    """

    alone: "Detection | None" = None
    inertial = True


@dataclass(frozen=True)
class Comparison:
    """What the default knows of a vehicle; `learned` is None where no healthy log was given.

    Args:
        learned: usual changes, limits, lags and facts from healthy logs.
        summary: how it was fitted; for people.
        channels, sensors: of the log it was fitted on, as a live sample has them.
        vehicle: its class as the user names it, for logs without a model; empty: it is guessed.
    """

    learned: Learned | None = None
    summary: dict[str, Any] = field(default_factory=dict)
    channels: tuple[Channel, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    method: str = METHOD
    vehicle: str = ""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Paths of the channels, in the order of a live sample."""
        return tuple(channel.path for channel in self.channels)

    @cached_property
    def description(self) -> VehicleFile | None:
        """What the columns of the log were read as that it was fitted on; give it to `read` as `model`. None: unknown.

        Raises:
            LogError: what the model file says of it cannot be read.
        """
        return known(self.summary, None, self.sensors)

    def sample(self, row: Mapping[str, float]) -> Float[np.ndarray, " C"]:
        """One row of the log's columns, by name and in the units of the log, as the values of a live sample [SI].

        A column that is not in the row has no value.

        Raises:
            LogError: the model does not know the columns, or none of them is in the row.
        """
        return sample(self.description, self.inputs, row)

    def __repr__(self) -> str:
        return f"<Comparison {show.comparison_line(self.sensors, self.summary)}>"


def comparison_of(*logs: Log, vehicle: str = "") -> Comparison:
    """What healthy logs of one vehicle teach the default method. `vehicle`: its class; empty: it is guessed.

    Raises:
        LogError: no two sensors of it can be compared.
    """
    logs = tuple(log.measurements() for log in logs)
    learned = fitted(list(logs), vehicle)
    names = ", ".join(log.name for log in logs)
    if not learned.limit:
        raise NothingToCompare(
            f"{names}: no two of its sensors measure the same; fit a method for single sensors, as "
            "relative-conditioning (--method)."
        )
    seconds = sum(log.duration_s for log in logs)
    summary = {"training_log": names, "training_s": seconds, "vehicle": learned.vehicle, **described(logs[0])}
    return Comparison(learned, summary, logs[0].channels, logs[0].sensors)


def compare(log: Log, comparison: Comparison | None = None) -> Detection:
    """Judge a log by what its sensors say of each other. Without a fitted comparison the limits are the log's own.

    Raises:
        LogError: the log has no rows.
    """
    if not len(log):
        raise LogError(f"{log.name} has no rows; give a log that has some.")
    check(log, comparison.description if comparison else None)
    log = log.measurements()
    known = comparison or Comparison()
    found = _detection(log, judge(log, known.learned, known.vehicle))
    assert found.coverage is not None
    if not found.coverage.compared and not found.coverage.alone:
        raise _nothing(log, found.coverage)
    return found


def _nothing(log: Log, coverage: Coverage) -> NothingToCompare:
    listed = list(coverage.not_compared.items())[:REASONS_SHOWN]
    reasons = "; ".join(f"{name}: {reason}" for name, reason in listed) or "it has none"
    return NothingToCompare(
        f"{log.name}: none of its sensors can be checked ({reasons}); give a longer log, or name a --method."
    )


class ComparingDetector:
    """Judges consecutive parts of one log; the first part sets the limits if no comparison was fitted."""

    def __init__(self, comparison: Comparison | None = None, see: Any = None) -> None:
        self._learned = comparison.learned if comparison else None
        self._vehicle = comparison.vehicle if comparison else ""
        self._description = comparison.description if comparison else None
        self._see = see
        self._tail: Log | None = None
        self._first: Log | None = None
        self._last: Detection | None = None
        self._events: list[Event] = []
        self._rows = self._parts = 0

    def take(self, part: Log, share: float = 1.0) -> None:
        """Judge the next part. `share`: how much of all that is judged it is."""
        check(part, self._description)
        part = part.measurements()
        log = part if self._tail is None else _joined(self._tail, part)
        judged = judge(log, self._learned, self._vehicle)
        self._learned = self._learned or judged.learned
        found = _detection(log, judged).between(float(part.time[0]))
        self._check(log, found, judged.signals)
        self._add(found.events, float(part.time[0]))
        self._first = self._first or part.between(end_s=float(part.time[min(1, len(part) - 1)]))
        self._rows, self._parts = self._rows + len(part), self._parts + 1
        self._tail = log.between(float(log.time[-1]) - OVERLAP_S)
        self._last = replace(found, events=tuple(self._events))
        if self._see is not None:
            self._see(self._last, share)

    def found(self, said: ReadingNotes | None = None) -> Detection:
        """The result so far; with all rows if there was only one part."""
        assert self._last is not None
        assert self._first is not None
        found = self._last
        if said is not None:
            notes = tuple(dict.fromkeys((*said.notes, *found.log.notes)))
            found = replace(found, log=replace(found.log, notes=notes, damage=said.damage))
        if self._parts == 1:
            return found
        last = found.log.between(float(found.log.time[-1]))
        return found.without_rows(_joined(self._first, last), self._rows)

    def _check(self, log: Log, found: Detection, signals: dict[str, Signal]) -> None:
        """Whether anything was compared.

        Raises:
            NothingToCompare: in the first part nothing was.
        """
        assert found.coverage is not None
        if self._parts == 0 and not found.coverage.compared:
            nothing = _nothing(log, found.coverage)
            nothing.alone = found if found.coverage.alone else None
            roles = {signal.role for signal in signals.values()}
            nothing.inertial = not roles or bool(roles & {"gyro", "accelerometer"})
            raise nothing

    def _add(self, events: tuple[Event, ...], start_s: float) -> None:
        """Events of the next part; one that was ongoing at the seam goes on."""
        for event in events:
            before = next((e for e in self._events if e.end_s is None and e.sensor == event.sensor), None)
            if before is not None and event.start_s <= start_s + OVERLAP_S:
                self._events[self._events.index(before)] = replace(before, end_s=event.end_s)
            else:
                self._events.append(event)
        over = [
            e
            for e in self._events
            if e.end_s is None and not any(e.sensor == n.sensor and n.end_s is None for n in events)
        ]
        for event in over:
            self._events[self._events.index(event)] = replace(event, end_s=max(event.start_s, start_s))


def _joined(first: Log, second: Log) -> Log:
    return replace(
        second,
        time=np.concatenate([first.time, second.time]),
        value=np.concatenate([first.value, second.value]),
        fresh=np.concatenate([first.fresh, second.fresh]),
    )


def _detection(log: Log, judged: Judged) -> Detection:
    sensors = [sensor.name for sensor in log.sensors]
    coverage = _coverage(log, judged)
    tested = tested_sensors(log.time, judged, sensors)
    events = events_of(judged, float(log.time[-1]))
    sensor = np.where(tested, OK, UNKNOWN).astype(np.int8)
    sample = np.where(tested.any(axis=1), OK, UNKNOWN).astype(np.int8)
    for event in events:
        end_s = np.inf if event.end_s is None else event.end_s + EXACT_S
        rows = slice(*np.searchsorted(log.time, (event.start_s - EXACT_S, end_s)))
        sample[rows] = FAULT
        if event.sensor in sensors:
            sensor[rows, sensors.index(event.sensor)] = FAULT
    owner = [sensors.index(channel.sensor) for channel in log.channels]
    channel = sensor[:, owner]
    return Detection(
        log=log,
        method=METHOD,
        watched=tuple(one.sensor in coverage.compared and one.kind not in SAID for one in log.channels),
        channel=channel,
        sensor=sensor,
        sample=sample,
        motion=np.full(len(log), UNKNOWN, np.int8),
        repaired=np.where(channel == FAULT, np.nan, log.value),
        traces=_traces(log, judged),
        events=by_onset(events, clock_events(log, METHOD)),
        coverage=coverage,
    )


def _coverage(log: Log, judged: Judged) -> Coverage:
    partners: dict[str, dict[str, None]] = {}
    for piece in judged.pieces:
        for test in piece.tests:
            devices = dict.fromkeys(sensor_of(device, judged.signals) for (device, _), _ in test.relation.blame)
            for one in devices:
                partners.setdefault(one, {}).update(dict.fromkeys(other for other in devices if other != one))
    for signal in judged.signals.values():
        if signal.role == RANGE_ROLE:
            partners.setdefault(signal.sensor, {})[SATELLITES] = None
    compared = {name: tuple(others) or (name,) for name, others in partners.items()}
    roles = {signal.sensor for signal in judged.signals.values()}
    checked = {s.sensor for s in judged.signals.values() if s.role not in NO_LEVELS} if judged.pieces else set()
    why = next((m.why for m in judged.mountings.values() if m.turn is None), "")
    reasons = {}
    for sensor in log.measurements().sensors:
        if sensor.name in compared:
            continue
        if sensor.name not in roles:
            reasons[sensor.name] = "no relation to other sensors is known"
        elif not judged.pieces:
            reasons[sensor.name] = f"too short to judge, less than {SHORTEST_S:g} s without a pause"
        else:
            reasons[sensor.name] = why or "no other sensor measures the same"
    return Coverage(compared, reasons, tuple(name for name in reasons if name in checked))


def tested_sensors(time: Float[np.ndarray, " T"], judged: Judged, sensors: list[str]) -> Bool[np.ndarray, "T S"]:
    """Rows at which some comparison of a sensor had something to compare."""
    tested = np.zeros((len(time), len(sensors)), bool)
    for piece, score in zip(judged.pieces, judged.scores, strict=True):
        if not piece.tests:
            continue
        tick = np.searchsorted(piece.grid.time, time - EXACT_S)
        inside = (time >= piece.grid.start_s) & (time <= piece.grid.end_s)
        tick = np.clip(tick, 0, len(piece.grid.time) - 1)
        there = np.isfinite(score)
        devices = [dict.fromkeys(device for (device, _), _ in test.relation.blame) for test in piece.tests]
        of = {device: sensor_of(device, judged.signals) for mine in devices for device in mine}
        for i, sensor in enumerate(sensors):
            mine = [any(of[device] == sensor for device in one) for one in devices]
            if any(mine):
                tested[:, i] |= inside & _held(there[:, mine].any(axis=1))[tick]
    for signal in judged.signals.values():
        if signal.role == RANGE_ROLE and signal.sensor in sensors:  # held against all other satellites at each epoch
            last = np.searchsorted(signal.time, time + EXACT_S) - 1
            since = time - signal.time[np.maximum(last, 0)]
            tested[:, sensors.index(signal.sensor)] |= (last >= 0) & (since < 1.5 * signal.period_s)
    return tested


def _held(tested: Bool[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
    """A comparison stands for HELD_S: the next measurement of a slow sensor may not be there yet."""
    held = tested.copy()
    for later in range(1, round(HELD_S / STEP_S) + 1):
        held[later:] |= tested[:-later]
    return held


def _traces(log: Log, judged: Judged) -> tuple[Trace, ...]:
    """For each relation the largest of its windows, in units of the limit."""
    names = list(dict.fromkeys(test.relation.name for piece in judged.pieces for test in piece.tests))
    traces = []
    for name in names:
        score: Float[np.ndarray, " T"] = np.full(len(log), np.nan)
        for piece, scores in zip(judged.pieces, judged.scores, strict=True):
            mine = [k for k, test in enumerate(piece.tests) if test.relation.name == name]
            if not mine:
                continue
            there = np.isfinite(scores[:, mine])
            most = np.where(there, np.abs(np.nan_to_num(scores[:, mine])), 0.0).max(axis=1)
            most[~there.any(axis=1)] = np.nan
            rows = (log.time >= piece.grid.time[0]) & (log.time <= piece.grid.time[-1])
            score[rows] = most[np.searchsorted(piece.grid.time, log.time[rows])]
        if np.isfinite(score).any():
            traces.append(Trace(name, None, score, np.ones(len(log))))
    return tuple(traces)
