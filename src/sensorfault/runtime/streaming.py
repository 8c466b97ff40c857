"""A log through a model as it is read: part by part, or as one part that is the whole."""

from collections.abc import Callable
from pathlib import Path

from sensorfault.logs.parts import read_parts
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.runtime.detector import Detector, See, joined
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import Progress
from sensorfault.runtime.result import Detection

EARLY = 1 << 22  # numbers (32 MB) of a log read in parts that a model is fitted on if none is given

Fit = Callable[[Log], Model]
Tell = Callable[[float], None]  # gets the share of the log that has been read, 0 to 1
# Reads a log: gives its consecutive parts to the first argument, and before each the share read so far to the second.
Parts = Callable[[Callable[[Log], None], Tell], ReadingNotes]


def detect_file(
    model: Model | Fit,
    path: Path,
    vehicle: str | Path | VehicleFile | None = None,
    tell: Tell = lambda share: None,
    see: See | None = None,
    learn: float = 0.5,
) -> Detection:
    """The events that `detect` finds in the same file, in memory that does not grow with the file.

    The columns are read as the model knows them.

    Args:
        model: what judges the log; or what fits it, see `detect_parts`.
        path: the file, of a format that `read_parts` reads.
        vehicle: as for `read`.
        tell: gets the share of the file that has been read, 0 to 1.
        see: gets each part that was judged, with all events so far, and its share of what is judged in all.
        learn: share of the file to fit on, if `model` is what fits one.

    Raises:
        LogError: as `read_parts` and `detect`; or a model of satellite epochs, which needs the log as a whole.
    """

    def parts(take: Callable[[Log], None], received: Tell) -> ReadingNotes:
        def both(share: float) -> None:
            received(share)
            tell(share)

        return read_parts(path, take, vehicle, both, model.description if isinstance(model, Model) else None)

    return detect_parts(parts, model, see, learn)


def detect_parts(
    parts: Parts,
    model: Model | Fit,
    see: See | None = None,
    learn: float = 0.5,
    whole: bool = False,
    progress: Progress | None = None,
) -> Detection:
    """Judge a log as it is read.

    `model` may also be what fits one. Then it gets the log's beginning, which is assumed healthy: `learn` of the log,
    of a log in parts no more than EARLY numbers. Only the rest is judged.

    `whole`: the log comes as one part. `progress` gets the share of each part that is judged. The rest as in
    `detect_file`.

    Raises:
        LogError: as `parts` and `detect`; or a model of satellite epochs and a log in parts.
    """
    run = _Run(model, see, learn, whole, progress)
    return run.found(parts(run.take, run.tell))


def beginning_s(log: Log, share: float, most: int | None = None) -> float:
    """Where to cut a log that a model is fitted on and that it then judges [s].

    After `share` of its time; earlier if that is more than `most` numbers; at the latest at its last row.
    """
    rows = len(log) - 1 if most is None else min(most // max(1, len(log.channels)), len(log) - 1)
    return min(float(log.time[0]) + share * log.duration_s, float(log.time[rows]))


class _Run:
    """Passes parts on to a detector; as long as there is no model, keeps them to fit one."""

    def __init__(
        self, model: Model | Fit, see: See | None, learn: float, whole: bool, progress: Progress | None
    ) -> None:
        self._see, self._learn, self._whole, self._progress = see, learn, whole, progress
        self._detector: Detector | None = None
        self._fit: Fit = model if not isinstance(model, Model) else lambda log: model
        self._early: list[Log] = []
        self._fitted_on_s: tuple[float, float] | None = None
        self._read = self._judged = self._fitted = 0.0  # shares of the log
        if isinstance(model, Model):
            self._detector = self._detector_of(model)

    def tell(self, share: float) -> None:
        """How much of the log has been read."""
        self._read = share

    def take(self, part: Log) -> None:
        """The next part."""
        if self._detector is not None:
            self._judge(self._detector, part, self._read)
            return
        self._early.append(part)
        if self._read > self._learn or self._whole or sum(one.value.size for one in self._early) >= EARLY:
            self._begin(1.0 if self._whole else max(self._read, self._learn))

    def found(self, said: ReadingNotes) -> Detection:
        """The result, after the last part."""
        detector = self._detector or self._begin(1.0)
        return detector.found(said, self._fitted_on_s)

    def _begin(self, share: float) -> Detector:
        """Fit on the beginning of what has been read, the `share` of the log, and judge the rest of it."""
        log = joined(self._early)
        self._early.clear()
        cut_s = beginning_s(log, self._learn / share, None if self._whole else EARLY)
        early = log.between(end_s=cut_s)
        self._detector = self._detector_of(self._fit(early))
        self._fitted_on_s = float(log.time[0]), cut_s
        self._judged = self._fitted = share * len(early) / len(log)
        self._judge(self._detector, log.between(cut_s), share)
        return self._detector

    def _judge(self, detector: Detector, part: Log, read: float) -> None:
        detector.take(part, (read - self._judged) / (1 - self._fitted), self._progress)
        self._judged = read

    def _detector_of(self, model: Model) -> Detector:
        if model.framing and not self._whole:
            raise LogError(
                f"{model.method} judges epochs of satellites, for which a log is not cut in parts; "
                "read it whole (--whole)."
            )
        return Detector(model, self._see)
