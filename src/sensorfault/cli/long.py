"""What `detect` does with a log that is too long to be read whole."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from sensorfault.cli import show

if TYPE_CHECKING:
    from sensorfault.long_log import LongDetection

LARGE = 10**9  # bytes; a larger file is read part by part unless told otherwise


def by_parts(path: Path, vehicle: Path | None, said: bool | None, model: Path | None, report: Path | None) -> bool:
    """Whether to read a log part by part: as the user said, else where it is large and can be.

    Raises:
        LogError: said so, without a model or with a report.
    """
    from sensorfault.logs import LogError
    from sensorfault.logs.parts import has_parts

    if said and model is None:
        raise LogError(f"{path}: --by-parts needs a --model, which 'sensorfault fit' writes from a shorter log.")
    if said and report is not None:
        raise LogError(f"{report}: a report needs the whole log; leave out --by-parts, or --report.")
    if said is not None or model is None or report is not None:
        return bool(said)
    return path.is_file() and path.stat().st_size > LARGE and has_parts(path, vehicle)


def detect(path: Path, vehicle: Path | None, model_path: Path) -> "LongDetection":
    """Read and judge part by part, and say what reading found."""
    from sensorfault.long_log import detect_long
    from sensorfault.store import load

    with show.reading(path.name) as tell:
        found = detect_long(load(model_path), path, vehicle, tell)
    show.say(f"{found.log.name}: {found.rows} rows to {show.clock(found.end_s)}, read part by part.")
    for note in found.notes:
        show.say(f"  {note}")
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
