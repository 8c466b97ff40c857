"""A long log through a model, part by part: the events, in memory that does not grow with the log."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sensorfault.events.event import Event
from sensorfault.logs.parts import read_parts
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.runtime.extractor import EventExtractor
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_on
from sensorfault.runtime.result import Detection, detected

EARLY = 1 << 22  # numbers, 32 MB of them, that a model is fitted on where none is given


@dataclass(frozen=True)
class LongDetection:
    """What was found in a log that was never in memory as a whole.

    `log` is the first and the last row that were judged, with its names and clock. `notes`: what reading found.
    `fitted_on_s`: from where to where the log was taken as healthy, if the model is its own.
    """

    log: Log
    model: Model
    rows: int
    events: tuple[Event, ...]
    notes: tuple[str, ...]
    fitted_on_s: tuple[float, float] | None = None


def detect_long(
    model: Model | Callable[[Log], Model],
    path: Path,
    vehicle: str | Path | VehicleFile | None = None,
    tell: Callable[[float], None] = lambda share: None,
    see: Callable[[Detection, float], None] | None = None,
    learn: float = 0.5,
) -> LongDetection:
    """The events that `detect` finds in the same file; verdicts and scores of single rows are not kept.

    `model` may also be what fits one: it is given the log's beginning, `learn` of the file but no more than EARLY
    numbers, and the rest is judged. `see` is shown each part that is judged, with all events so far, and the share of
    the file that it is.

    Raises:
        LogError: as `read_parts` and `detect` say, or a model of epochs, which are not cut between parts.
    """
    given, fit = (model, None) if isinstance(model, Model) else (None, model)
    judging = None if given is None else _Judging(_taken(given, path), see)
    early: list[Log] = []
    fitted_on_s, read = None, 0.0

    def received(share: float) -> None:
        nonlocal read
        read = share
        tell(share)

    def take(part: Log) -> None:
        if judging is not None:
            judging.take(part, read)
            return
        early.append(part)
        if read > learn or sum(one.value.size for one in early) >= EARLY:
            begin(max(read, learn))

    def begin(share: float) -> None:
        """Fit on the beginning of what there is, the `share` of the file, and judge the rest of it."""
        nonlocal judging, fitted_on_s
        assert fit is not None
        log = _joined(early)
        early.clear()
        rows = min(round(len(log) * learn / share), EARLY // len(log.channels), len(log) - 1)
        cut_s = float(log.time[rows])
        fitted_on_s = float(log.time[0]), cut_s
        judging = _Judging(_taken(fit(log.between(end_s=cut_s)), path), see, share * rows / len(log))
        judging.take(log.between(cut_s), share)

    said = read_parts(path, take, vehicle, received)
    if judging is None:
        begin(1.0)
    assert judging is not None
    assert judging.ends is not None
    events = tuple(judging.extractor.events)
    return LongDetection(judging.ends, judging.model, judging.rows, events, said.notes, fitted_on_s)


def _taken(model: Model, path: Path) -> Model:
    if model.framing:
        raise LogError(
            f"{path}: {model.method} judges epochs of satellites, which are not cut in parts; read it whole (--whole)."
        )
    return model


class _Judging:
    """The monitor's state between two parts."""

    def __init__(self, model: Model, see: Callable[[Detection, float], None] | None, read: float = 0.0) -> None:
        self.model, self.extractor = model, EventExtractor(model)
        self.ends: Log | None = None  # the first row and the last
        self.rows = 0
        self._see, self._read = see, read
        self._state = model.monitor.init()

    def take(self, part: Log, read: float) -> None:
        """The next part; `read`: the share of the file that has been."""
        log = self.model.take(part)
        self.ends = _joined([_row(self.ends or log, 0), _row(log, -1)])
        self._state, result = replay_on(self.model.monitor, self._state, log)
        self.extractor.take(log, result)
        self.rows += len(log)
        if self._see is not None:
            self._see(detected(self.model, log, result, self.extractor.events), read - self._read)
            self._read = read


def _row(log: Log, i: int) -> Log:
    return replace(log, time=log.time[[i]], value=log.value[[i]], fresh=log.fresh[[i]])


def _joined(parts: list[Log]) -> Log:
    return replace(
        parts[-1],
        time=np.concatenate([part.time for part in parts]),
        value=np.concatenate([part.value for part in parts]),
        fresh=np.concatenate([part.fresh for part in parts]),
    )
