"""What `detect` will be able to check in a log: the comparison that it makes is made, which fits nothing."""

from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sensorfault.cli import fitting, limits

if TYPE_CHECKING:
    from sensorfault.logs import Log
    from sensorfault.logs.vehicle import VehicleFile
    from sensorfault.runtime.compared import NothingToCompare

LEARN = 0.5  # share of the log that a method for single sensors is fitted on by default


@dataclass(frozen=True)
class Promise:
    """What detect can check, in sentences; or why it refuses the log. `pauses`: a sentence on those of the recording.

    `compared`, `alone`: sensors that are compared with others, and that are checked by themselves.
    """

    checks: tuple[str, ...] = ()
    refuses: str = ""
    pauses: tuple[str, ...] = ()
    compared: tuple[str, ...] = ()
    alone: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self) | {"refuses": self.refuses or None}


def promise(path: Path, vehicle: "VehicleFile") -> Promise:
    """What detect can do with the log as it is described; of a long log as its beginning shows it."""
    from sensorfault.logs import LogError

    try:
        return _of(_beginning(path, vehicle))
    except LogError as error:
        return Promise(refuses=str(error))


def _of(log: "Log") -> Promise:
    from sensorfault.logs.pauses import pauses_said
    from sensorfault.runtime.compared import ComparingDetector, NothingToCompare

    pauses = tuple(pauses_said(log.pauses))
    detector = ComparingDetector()
    try:
        detector.take(log)
    except NothingToCompare as nothing:
        return _inertial(log, nothing, pauses)
    found = detector.found()
    assert found.coverage is not None
    return Promise(limits.of_coverage(found), "", pauses, tuple(found.coverage.compared), found.coverage.alone)


def _inertial(log: "Log", nothing: "NothingToCompare", pauses: tuple[str, ...]) -> Promise:
    """Of a log without two sensors that measure the same: those that a method for single sensors watches."""
    from sensorfault.calibration.data_screening import leave_out
    from sensorfault.logs import LogError
    from sensorfault.methods.inertial.needs import in_a_row

    half_s = float(log.time[0]) + LEARN * log.duration_s  # where detect cuts it
    early, _ = leave_out(log.measurements().between(end_s=half_s))
    try:
        training = in_a_row(fitting.INERTIAL, early) if len(early) > 1 else None
    except LogError:
        training = None
    if training is not None:
        watched = [channel.path for channel, w in zip(early.channels, training.watched, strict=True) if w]
        said = f"No two sensors measure the same; {fitting.INERTIAL} judges {limits.some(watched)}, each by itself."
        sensors = dict.fromkeys(path.partition(".")[0] for path in watched)
        return Promise((said, *limits.dropouts_only(training.reasons)), "", pauses, (), tuple(sensors))
    if nothing.alone is None or nothing.alone.coverage is None:
        return Promise(refuses=str(nothing), pauses=pauses)
    return Promise(limits.of_coverage(nothing.alone), "", pauses, (), nothing.alone.coverage.alone)


def _beginning(path: Path, vehicle: "VehicleFile") -> "Log":
    """The log, or the first part of one that is read part by part."""
    from sensorfault.logs import read
    from sensorfault.logs.parts import is_long_log, read_parts

    if not is_long_log(path):
        return read(path, vehicle)
    first: list[Log] = []

    def take(part: "Log") -> None:
        first.append(part)
        raise _Enough

    with suppress(_Enough):
        read_parts(path, take, vehicle)
    return first[0]


class _Enough(BaseException):
    """Ends the reading. Not an Exception, as readers catch those as damage."""
