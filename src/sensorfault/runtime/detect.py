"""Judge a log, or live samples, with a fitted model: verdicts and fault events."""

from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.expect import LOG, MODEL, expect, wrong
from sensorfault.core.times import clock
from sensorfault.core.verdicts import FAULT, UNKNOWN
from sensorfault.events.event import Event
from sensorfault.logs.epochs import Gather
from sensorfault.logs.phrase import counted
from sensorfault.logs.table import Log
from sensorfault.runtime.compared import Comparison, compare
from sensorfault.runtime.comparing_live import ComparingLive
from sensorfault.runtime.detector import Detector
from sensorfault.runtime.extractor import context_of
from sensorfault.runtime.live_clock import LiveClock
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import Progress
from sensorfault.runtime.result import Detection
from sensorfault.runtime.runners import Stepper, StepResult, nothing_yet
from sensorfault.runtime.tracker import Tracker


def detect(model: Model | Comparison | Log, log: Log | None = None, progress: Progress | None = None) -> Detection:
    """Judge every row of a log with a fitted model, whose monitor starts anew; or, of a log alone, with the default.

    >>> sf.detect(log)  # what its sensors say of each other, with limits from the log itself and the class of vehicle
    >>> sf.detect(model, log)

    Args:
        model: what `fit` or `load` returned, for C channels of S sensors; or the log, if there is no model.
        log: T rows in SI on one clock; it must have the model's channels, other channels are ignored.
        progress: called with the share that is done, 0 to 1.

    Returns:
        Verdicts (T x C channels, T x S sensors, T samples), events [s of the log's clock], scores and limits of each
        test, residuals and repaired values [SI].

    Raises:
        LogError: the log lacks a channel of the model, ticks at another rate, or is empty.
        TypeError: one of the two is something else.
    """
    if isinstance(model, Log) and log is None:
        return compare(model)
    expect(model, (Model, Comparison), "detect: model", MODEL)
    expect(log, Log, "detect: log", LOG)
    assert log is not None
    if isinstance(model, Comparison):
        return compare(log, model)
    assert isinstance(model, Model)
    detector = Detector(model)
    detector.take(log, progress=progress)
    return detector.found()


class Live:
    """A fitted model on a running vehicle: one sample in, one verdict out.

    >>> live = Live(model)
    >>> now = live.push(0.02, [0.01, 0.0, 0.12, 0.3, -0.1, 9.8])
    >>> now.sample  # 0 ok, 1 unknown, 2 fault

    `events` are those that have ended; `open()` returns those that are ongoing. A model of the default method compares
    the sensors once a second; between two comparisons its verdicts stand, and scores and residuals are empty.

    It can be pickled, and goes on where it was. After a fork the two processes have each a copy, which do not see each
    other's samples; do not fork while another thread pushes.

    Raises:
        TypeError: something else than a model.
        ValueError: a comparison that was not fitted.
    """

    def __init__(self, model: Model | Comparison) -> None:
        expect(model, (Model, Comparison), "Live: model", MODEL)
        self._model = model
        self.events: list[Event] = []
        held = {sensor.name: sensor.held for sensor in model.sensors}
        names = [channel.sensor for channel in model.channels]
        self._held = [np.flatnonzero([n == name for n in names]) for name in held if held[name]]
        self._fresh: Bool[np.ndarray, " C"] = np.ones(len(model.inputs), bool)
        self._last: Float[np.ndarray, " C"] = np.full(len(model.inputs), np.nan)
        self._time: float | None = None
        self._clock = LiveClock()
        self._comparing: ComparingLive | None = None
        if isinstance(model, Comparison):
            if model.learned is None:
                raise ValueError("live: this comparison was not fitted; fit one on a healthy log with sf.fit(log).")
            self._comparing = ComparingLive(model)
        else:
            self._prepare(model)

    def _prepare(self, model: Model) -> None:
        """Compile the step of a fitted monitor."""
        framing = model.framing
        self._gather = Gather(framing) if framing else None
        self._step = Stepper(model.monitor, framing.nothing if framing else ())
        self._watch = context_of(model)
        self._tracker = Tracker(self._watch)
        self._now = nothing_yet(model.monitor)
        self._begun = False
        self._epoch: float | None = None  # when the last one ended [s]

    def push(self, time: float, value: Any, fresh: Any = None) -> StepResult:
        """Judge one sample.

        Args:
            time: [s], greater than that of the sample before. A clock that was set back, or ahead by more than an
                hour, is followed once it has risen for 2 s; those samples are dropped. After a step back, times of
                events go on from the last one before.
            value: one for each of `model.inputs`, in their order, in SI units; NaN if absent.
            fresh: which values are new measurements, one for all or one each. By default a held sensor's values are new
                if one of its channels has changed, and all others are new.

        Returns:
            Verdicts (C channels, S sensors, the sample), scores and limits (K tests), residuals and values (C) [SI]. If
            the model judges epochs and this sample ends none, those on the last epoch.

        Raises:
            ValueError: time is not finite, did not rise or is far ahead, or there are not as many values as the
                model has inputs. The sample is dropped, and nothing has changed.
            TypeError: the time is no number, or the values are not numbers.
        """
        row = _row(value)
        if len(row) != len(self._fresh):
            width = len(self._fresh)
            raise ValueError(f"live: {len(row)} values for {width} channels; push one for each, NaN if absent.")
        if not isinstance(time, int | float | np.number):
            raise wrong(time, "live: time", "the time of the sample, in seconds")
        if fresh is not None:
            fresh = np.asarray(fresh, bool)
            fresh = fresh if fresh.shape == row.shape else np.broadcast_to(fresh, len(row))
        time = self._clock.take(float(time))
        if fresh is None:
            fresh = self._fresh if not self._held else self._changed(row)
        before, self._time = self._time, time
        gap_s = 0.0 if before is None else self._time - before
        if self._comparing is not None:
            return self._compare(self._comparing, row, fresh)
        if self._gather is None:
            return self._judge(self._time, gap_s, row, fresh)
        cut = self._gather.push(self._time, row, np.broadcast_to(fresh, len(row)))
        if cut is None:
            return self._now
        gap_s, self._epoch = (0.0 if self._epoch is None else self._time - self._epoch), self._time
        block = type(cut.epoch)(*(array[0] for array in cut.epoch))
        self._now = self._judge(self._time, gap_s, cut.value[0], cut.fresh[0], block)
        return self._now

    def _compare(
        self, comparing: ComparingLive, value: Float[np.ndarray, " C"], fresh: Bool[np.ndarray, " C"]
    ) -> StepResult:
        assert self._time is not None
        self.events += comparing.push(self._time, value, fresh)
        channel, none = comparing.channel, np.empty(0)
        stand_in = np.where(channel == FAULT, np.nan, value)
        untested, silence = np.zeros(len(value), bool), np.zeros(len(value))
        residual = np.full(len(value), np.nan)
        verdicts = channel, comparing.sensor.copy(), comparing.sample, UNKNOWN
        return StepResult(*verdicts, none, none, stand_in, residual, untested, silence)

    def _judge(
        self, time: float, gap_s: float, value: Float[np.ndarray, " C"], fresh: Any, block: Any = ()
    ) -> StepResult:
        now = self._step.push(time, value, fresh, block)
        # The tracker can skip a row without fault, silence or hole before it while no event is open.
        silent = gap_s > self._watch.hole_s or (now.silence > self._watch.silent_after_s).any()
        if FAULT in (now.sample, now.motion) or silent or not self._begun or self._tracker.busy():
            self._begun = True
            self.events += self._tracker.push(time, gap_s, value, now)
        return now

    def __repr__(self) -> str:
        at = "no sample yet" if self._time is None else f"at {clock(self._time)}"
        ended, ongoing = counted(len(self.events), "event"), len(self.open())
        return f"<Live {at}, {ended} ended and {ongoing} ongoing: {self._model!r}>"

    def open(self) -> list[Event]:
        """Ongoing events; their end_s is None."""
        return self._comparing.open() if self._comparing is not None else self._tracker.open()

    def _changed(self, value: Float[np.ndarray, " C"]) -> Bool[np.ndarray, " C"]:
        fresh = self._fresh.copy()
        for channels in self._held:
            fresh[channels] = (value[channels] != self._last[channels]).any()
        self._last = np.where(np.isfinite(value), value, self._last)
        return fresh


def _row(value: Any) -> Float[np.ndarray, " C"]:
    """The values of one sample.

    Raises:
        TypeError: not numbers, one after the other.
    """
    try:
        row: Float[np.ndarray, " C"] = np.asarray(value, float)
    except (TypeError, ValueError):
        row = np.zeros(())
    if row.ndim != 1:
        raise wrong(value, "live: value", "a list or an array of numbers, one for each channel, NaN if absent")
    return row
