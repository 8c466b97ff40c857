"""What verbs do with a log that is too long to be read whole."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from sensorfault.cli import show, work

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sensorfault.faults.fault import Fault
    from sensorfault.logs import Log
    from sensorfault.logs.joining import Said
    from sensorfault.logs.summary import Summing
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection
    from sensorfault.runtime.streaming import LongDetection


class Wanted(NamedTuple):
    """The model to judge by; or what to fit, and on what share of the log."""

    model: Path | None
    method: str
    learn: float
    seed: int


def by_parts(path: Path, said: bool | None) -> bool:
    """Whether to read a log part by part: as the user said, else where it is long and can be."""
    from sensorfault.logs.parts import is_long_log

    return is_long_log(path) if said is None else said


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
    path: Path,
    vehicle: Path | None,
    wanted: Wanted,
    report: Path | None = None,
    truth: "Sequence[Fault]" = (),
) -> "LongDetection":
    """Read and judge part by part, say what reading found, and draw the `report`."""
    from sensorfault.methods.fit import fit
    from sensorfault.report.page import write_sketch
    from sensorfault.report.page_sketch import Sketch
    from sensorfault.runtime.store import load
    from sensorfault.runtime.streaming import detect_long

    work.check_learn(wanted.learn)
    sketches = list[Sketch]()

    def see(part: "Detection", share: float) -> None:
        if not sketches:
            sketches.append(Sketch(part))
        sketches[0].take(part, share)

    def fitted(early: "Log") -> "Model":
        return fit(early, wanted.method, held_out=0.0, seed=wanted.seed)

    model = load(wanted.model) if wanted.model is not None else fitted
    with show.reading(path.name) as tell:
        found = detect_long(model, path, vehicle, tell, see if report is not None else None, wanted.learn)
    _say(found.log.name, found.rows, float(found.log.time[-1]), found.notes)
    result = work.own_limits(found.model, *found.fitted_on_s) if found.fitted_on_s else work.limits(found.model)
    if found.fitted_on_s:
        for sentence in result:
            show.say(sentence)
    if report is not None:
        write_sketch(sketches[0], report, truth, summary=result, notes=found.notes)
        show.say(f"Wrote {report}.")
    return found


def answer(found: "LongDetection") -> dict[str, Any]:
    """The JSON of it."""
    return work.answer(found.model, found.log, found.notes, found.fitted_on_s, found.events)


def _say(name: str, rows: int, end_s: float, notes: tuple[str, ...]) -> None:
    show.say(f"{name}: {rows} rows to {show.clock(end_s)}, read part by part.")
    for note in notes:
        show.say(f"  {note}")
