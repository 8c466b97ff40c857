"""What verbs do with a log that is too long to be read whole."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from sensorfault.cli import show, work

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sensorfault.detection import Detection
    from sensorfault.faults.fault import Fault
    from sensorfault.logs.joining import Said
    from sensorfault.logs.summary import Summing
    from sensorfault.long_log import LongDetection


def by_parts(path: Path, said: bool | None) -> bool:
    """Whether to read a log part by part: as the user said, else where it is long and can be."""
    from sensorfault.logs.parts import is_long_log

    return is_long_log(path) if said is None else said


def judged_by_parts(path: Path, said: bool | None, model: Path | None) -> bool:
    """The same where it is to be judged.

    Raises:
        LogError: said so, without a model.
    """
    from sensorfault.logs import LogError

    if said and model is None:
        raise LogError(f"{path}: --by-parts needs a --model, which 'sensorfault fit' writes from a shorter log.")
    return model is not None and by_parts(path, said)


def summed(path: Path, vehicle: Path | None) -> "tuple[Summing, Said]":
    """Read part by part and sum up what the log holds, and say what reading found."""
    from sensorfault.logs.parts import read_parts
    from sensorfault.logs.summary import Summing

    summing = Summing()
    with show.reading(path.name) as tell:
        said = read_parts(path, summing.take, vehicle, tell)
    assert summing.first is not None  # a file without a part is an error
    _say(summing.first.name, summing.rows, summing.end_s, said.notes)
    return summing, said


def detect(
    path: Path, vehicle: Path | None, model_path: Path, report: Path | None = None, truth: "Sequence[Fault]" = ()
) -> "LongDetection":
    """Read and judge part by part, say what reading found, and draw the `report`."""
    from sensorfault.evaluation.page import write_sketch
    from sensorfault.evaluation.page_sketch import Sketch
    from sensorfault.long_log import detect_long
    from sensorfault.store import load

    model, sketches = load(model_path), list[Sketch]()

    def see(part: "Detection", share: float) -> None:
        if not sketches:
            sketches.append(Sketch(part))
        sketches[0].take(part, share)

    with show.reading(path.name) as tell:
        found = detect_long(model, path, vehicle, tell, see if report is not None else None)
    _say(found.log.name, found.rows, found.end_s, found.notes)
    if report is not None:
        write_sketch(sketches[0], report, truth, summary=work.limits(model), notes=found.notes)
        show.say(f"Wrote {report}.")
    return found


def answer(found: "LongDetection") -> dict[str, Any]:
    """The JSON of it."""
    return {
        "log": found.log.name,
        "method": found.method,
        "judged_s": [float(found.log.time[0]), found.end_s],
        "notes": list(found.notes),
        "events": [event.as_dict() for event in found.events],
    }


def _say(name: str, rows: int, end_s: float, notes: tuple[str, ...]) -> None:
    show.say(f"{name}: {rows} rows to {show.clock(end_s)}, read part by part.")
    for note in notes:
        show.say(f"  {note}")
