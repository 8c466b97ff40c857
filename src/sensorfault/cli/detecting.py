"""Detect the faults of a log, with progress."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sensorfault.cli import fitting, limits, reading, show

if TYPE_CHECKING:
    from sensorfault.logs import Log
    from sensorfault.runtime.compared import Comparison, NothingToCompare
    from sensorfault.runtime.detector import See
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection
    from sensorfault.runtime.streaming import Parts


def detect(model: "Model", log: "Log", doing: str = "judging") -> "Detection":
    """Judge a log that has been read."""
    from sensorfault.runtime.detect import detect

    with show.progress() as bar:
        task = bar.add_task(doing, total=1.0)
        return detect(model, log, lambda share: bar.update(task, completed=share))


def detect_log(
    path: Path,
    vehicle: Path | None,
    by_parts: bool | None,
    choice: fitting.Choice,
    see: "See | None" = None,
    rate_hz: float | None = None,
) -> "Detection":
    """Read and judge a log, by the chosen model or by its own; print what reading found, and limits of its own model.

    `by_parts`: see `reading.in_parts`. `see` gets each part that was judged, as in `detect_file`.
    """
    parts = reading.in_parts(path, by_parts)
    read = partial(reading.read_in, parts, path, vehicle, model=fitting.known_by(choice), rate_hz=rate_hz)
    comparison = fitting.comparison_of(choice)
    if comparison is not None:
        from sensorfault.runtime.compared import NothingToCompare

        try:
            return _compared(read, comparison, see)
        except NothingToCompare as nothing:
            return _inertial(nothing, partial(read, quiet=True), parts, choice, see)
    return _fitted(read, parts, choice, see)


def _inertial(
    nothing: "NothingToCompare", quiet: "Parts", parts: bool, choice: fitting.Choice, see: "See | None"
) -> "Detection":
    """A log without two sensors that measure the same: an inertial unit is still judged by itself.

    Raises:
        LogError: nothing of the log can be judged.
    """
    from sensorfault.logs import LogError

    if choice.path is not None:
        raise nothing
    if nothing.alone is not None and not nothing.inertial:
        return nothing.alone
    try:
        found = _fitted(quiet, parts, replace(choice, method=fitting.INERTIAL), see)
    except LogError:
        if nothing.alone is None:
            raise nothing from None
        return nothing.alone
    show.say(f"No two of its sensors measure the same: its channels are judged by {fitting.INERTIAL}, each by itself.")
    return found


def _fitted(read: "Parts", parts: bool, choice: fitting.Choice, see: "See | None") -> "Detection":
    """By a stored model, or by a method that is fitted on the beginning of the log."""
    from sensorfault.runtime.streaming import detect_parts

    with show.patient("judging") as judged:
        model = fitting.model_or_fit(choice)
        found = detect_parts(read, model, see, choice.learn, whole=not parts, progress=None if parts else judged)
    if found.fitted_on_s is not None:
        for sentence in limits.of_detection(found):
            show.say(sentence)
    return found


def _compared(read: "Parts", comparison: "Comparison", see: "See | None") -> "Detection":
    """By what the sensors say of each other; needs no compiler."""
    from sensorfault.runtime.compared import ComparingDetector

    detector = ComparingDetector(comparison, see)
    before = now = 0.0

    def tell(share: float) -> None:
        nonlocal now
        now = share

    def take(part: "Log") -> None:
        nonlocal before
        detector.take(part, now - before)
        before = now

    return detector.found(read(take, tell))
