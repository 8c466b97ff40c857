"""Compare events with the injected faults: which were detected, when, on which channel; and the false alarms."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sensorfault.core.expect import DETECTION, FAULTS, LOG, expect, expect_all
from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Log
from sensorfault.numerics.poisson import rate_below
from sensorfault.runtime.model import TOGETHER
from sensorfault.runtime.result import Detection

GRACE_S = 1.0  # an event that begins within this time after a fault's end still belongs to it [s]


@dataclass(frozen=True)
class Outcome:
    """Result for one injected fault.

    `delay_s`: time from onset to the first alarm, NaN if there was none. `sensor_right`, `channel_right`, `kind_right`
    are about this first alarm. `false_isolations`: events during the fault on healthy channels. `error_before`,
    `error_after`: RMS over the fault of measured and of repaired minus true values, in healthy sigmas; NaN where there
    is nothing to compare.
    """

    fault: Fault
    found: bool
    delay_s: float
    sensor_right: bool
    channel_right: bool
    kind_right: bool
    named: Event | None
    false_isolations: int
    error_before: float
    error_after: float


@dataclass(frozen=True)
class Judgement:
    """Outcomes of all faults, the false alarms, and the hours without a fault in which they could happen."""

    outcomes: tuple[Outcome, ...]
    false_alarms: tuple[Event, ...]
    healthy_hours: float

    @property
    def false_alarms_per_hour(self) -> float:
        """NaN where there was no healthy time."""
        return len(self.false_alarms) / self.healthy_hours if self.healthy_hours > 0 else float("nan")

    @property
    def false_alarms_per_hour_below(self) -> float:
        """Upper limit of the rate with 95 % confidence."""
        return rate_below(len(self.false_alarms), self.healthy_hours)


def judge(detection: Detection, truth: Sequence[Fault], clean: Log | None = None) -> Judgement:
    """Compare the events with the injected faults; `clean`, the log before injection, is needed for the recovery error.

    An event belongs to a fault if it begins between the fault's onset and its end plus GRACE_S; an event that was
    ongoing at the onset does not count. No point adjustment.

    Raises:
        TypeError: something else than a detection, faults or a log.
    """
    expect(detection, Detection, "judge: detection", DETECTION)
    expect_all(truth, Fault, "judge: truth", FAULTS)
    expect(clean, (Log, type(None)), "judge: clean", LOG)
    events = detection.events
    outcomes = tuple(_outcome(fault, detection, clean) for fault in truth)
    explained = {id(event) for fault in truth for event in _of(fault, events, detection.period_s)}
    false_alarms = tuple(event for event in events if id(event) not in explained)
    faulty = covered_s([(f.start_s, f.end_s + GRACE_S) for f in truth])
    hours = max(0.0, detection.log.duration_s - faulty) / 3600
    return Judgement(outcomes, false_alarms, hours)


def noticed_s(event: Event) -> float:
    """When an event was first known; for a missing sensor that is when the allowed silence was over."""
    if event.kind == "missing" and event.limit is not None:
        return event.start_s + event.limit
    return event.start_s


def _of(fault: Fault, events: Sequence[Event], tick_s: float) -> list[Event]:
    first, last = fault.start_s - tick_s / 2, fault.end_s + GRACE_S
    # a missing event starts at the last measurement, which can lie before the onset if the clock has a gap
    mine = (event for event in events if first <= noticed_s(event) and event.start_s <= last)
    return sorted(mine, key=noticed_s)


def _outcome(fault: Fault, detection: Detection, clean: Log | None) -> Outcome:
    mine = _of(fault, detection.events, detection.period_s)
    before, after = _errors(fault, detection, clean) if clean else (float("nan"), float("nan"))
    if not mine:
        return Outcome(fault, False, float("nan"), False, False, False, None, 0, before, after)
    # The first alarm counts; of several at once, the one that names a sensor.
    first = min(mine, key=lambda event: (noticed_s(event), event.sensor is None))
    return Outcome(
        fault=fault,
        found=True,
        delay_s=max(0.0, noticed_s(first) - fault.start_s),
        sensor_right=first.sensor == fault.sensor,
        channel_right=_channel_right(fault, first),
        kind_right=first.kind == fault.kind,
        named=first,
        false_isolations=sum(not _channel_right(fault, event) for event in mine),
        error_before=before,
        error_after=after,
    )


def _channel_right(fault: Fault, event: Event) -> bool:
    """Whether an event names the faulty channel."""
    accused = [] if event.channel is None else event.channel.split(TOGETHER)
    return event.sensor == fault.sensor and (fault.channel is None or fault.channel in accused)


def _errors(fault: Fault, detection: Detection, clean: Log) -> tuple[float, float]:
    """RMS over the fault of measured and of repaired minus clean values, in units of the channel's healthy sigma."""
    log = detection.log
    faulty = [i for i, c in enumerate(log.channels) if c.sensor == fault.sensor and fault.channel in (None, c.name)]
    rows = (log.time >= fault.start_s) & (log.time <= fault.end_s)
    clean = clean.select(log.channels[i].path for i in faulty).between(log.time[0], log.time[-1] + log.period_s / 2)
    scale = np.nanstd(clean.value, axis=0)
    scale[scale == 0] = np.nan  # a channel that never moves has no sigma to measure errors in
    before, after = (
        _rms((value[rows][:, faulty] - clean.value[rows]) / scale) for value in (log.value, detection.repaired)
    )
    return before, after


def _rms(error: np.ndarray) -> float:
    error = error[np.isfinite(error)]
    return float(np.sqrt(np.mean(error**2))) if error.size else float("nan")


def covered_s(spans: list[tuple[float, float]]) -> float:
    """Length of the union of intervals [s]."""
    total, reach = 0.0, -np.inf
    for start, end in sorted(spans):
        total += max(0.0, end - max(start, reach))
        reach = max(reach, end)
    return total
