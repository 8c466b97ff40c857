"""A long log through a model, part by part: the events, in memory that does not grow with the log."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from sensorfault.detection import Detection, detected
from sensorfault.events import Event
from sensorfault.follow import Follower
from sensorfault.logs.parts import read_parts
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.model import Model
from sensorfault.replay import replay_on


@dataclass(frozen=True)
class LongDetection:
    """What was found in a log that was never in memory as a whole.

    `log` is its first row, with its names and clock. `notes`: what reading found.
    """

    log: Log
    method: str
    rows: int
    end_s: float
    events: tuple[Event, ...]
    notes: tuple[str, ...]


def detect_long(
    model: Model,
    path: Path,
    vehicle: str | Path | VehicleFile | None = None,
    tell: Callable[[float], None] = lambda share: None,
    see: Callable[[Detection, float], None] | None = None,
) -> LongDetection:
    """The events that `detect` finds in the same file; verdicts and scores of single rows are not kept.

    `see` is shown each part, with all events so far, and the share of the file that it is.

    Raises:
        LogError: as `read_parts` and `detect` say, or a model of epochs, which are not cut between parts.
    """
    if model.framing:
        raise LogError(
            f"{path}: {model.method} judges epochs of satellites, which are not cut in parts; read it whole."
        )
    judging = _Judging(model, see)

    def heard(share: float) -> None:
        judging.read = share
        tell(share)

    said = read_parts(path, judging.take, vehicle, heard)
    assert judging.first is not None  # a file without a part is an error
    events = tuple(judging.follower.events)
    return LongDetection(judging.first, model.method, judging.rows, judging.end_s, events, said.notes)


class _Judging:
    """The monitor's state between two parts. `read`: the share of the file that has been read."""

    def __init__(self, model: Model, see: Callable[[Detection, float], None] | None) -> None:
        self.model, self.see, self.follower = model, see, Follower(model)
        self.read = self._seen = 0.0
        self.first: Log | None = None
        self.rows, self.end_s = 0, 0.0
        self._state = model.monitor.init()

    def take(self, part: Log) -> None:
        log = self.model.take(part)
        if self.first is None:
            self.first = replace(log, time=log.time[:1], value=log.value[:1], fresh=log.fresh[:1])
        self._state, told = replay_on(self.model.monitor, self._state, log)
        self.follower.take(log, told)
        self.rows, self.end_s = self.rows + len(log), float(log.time[-1])
        if self.see is not None:
            self.see(detected(self.model, log, told, self.follower.events), self.read - self._seen)
            self._seen = self.read
