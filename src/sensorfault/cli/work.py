"""What verbs do to logs and models, with progress: read, find or fit the model, detect."""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sensorfault.cli import show

if TYPE_CHECKING:
    from sensorfault.events.event import Event
    from sensorfault.faults.fault import Fault
    from sensorfault.logs import Log
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection

WATCHED_SAID = 24
SUSPECTS_SAID = 10


def check_outputs(outputs: Sequence[Path | str | None], inputs: Sequence[Path | None]) -> None:
    """Before the work: every output has a folder to go to, is none itself, and is nobody's input.

    Raises:
        LogError: one of them is not so.
    """
    from sensorfault.logs import LogError

    read = {path.resolve() for path in inputs if path is not None}
    for path in (Path(output) for output in outputs if output not in (None, "-")):
        if not path.parent.is_dir():
            raise LogError(f"{path}: there is no folder {path.parent}; make it, or write somewhere else.")
        if path.is_dir():
            raise LogError(f"{path} is a folder; give a file to write.")
        if path.resolve() in read:
            raise LogError(f"{path} is read from and would be written over; give another file to write.")


def read_truth(path: Path) -> "tuple[Fault, ...]":
    """What `inject` did to a log.

    Raises:
        FaultError: not such a file.
    """
    from sensorfault.faults.fault import FaultError
    from sensorfault.faults.text import truth_from_json

    try:
        return truth_from_json(path.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise FaultError(f"{path}: not a text file; give the .truth.json that 'inject' wrote.") from None


def _memory() -> float:
    """Of this machine [bytes]; of a system that does not tell, as much as there need be."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return math.inf


def read_log(path: Path, vehicle: Path | None) -> "Log":
    """Read a log and say what reading found.

    Raises:
        LogError: as `read`, or the log is larger than this machine's memory.
    """
    from sensorfault.logs import LogError, read
    from sensorfault.logs.place import files_of

    size, memory = sum(file.stat().st_size for file in files_of(path)), _memory()
    if size > memory:
        raise LogError(
            f"{path}: {size / 1e9:.3g} GB cannot be read whole in {memory / 1e9:.3g} GB of memory; give a shorter log, "
            "or let detect, report and info read one file of most formats part by part (--by-parts)."
        )
    with show.reading(path.name) as tell:
        log = read(path, vehicle, tell=tell)
    show.say(f"{log.name}: {len(log)} rows, {log.duration_s:.1f} s, {len(log.sensors)} sensors.")
    for note in log.notes:
        show.say(f"  {note}")
    return log


@dataclass(frozen=True)
class Ready:
    """A model, the part of the log that it may be judged on, and how it came about, for people."""

    model: "Model"
    judged: "Log"
    fitted_on_s: tuple[float, float] | None
    sentences: tuple[str, ...]


def check_learn(learn: float) -> None:
    """Before the work: the share of the log to fit on.

    Raises:
        LogError: it is none.
    """
    from sensorfault.logs import LogError

    if not 0.05 <= learn <= 0.95:  # click takes NaN for a number
        raise LogError(f"--learn is {learn:g}; give the share of the log to fit on, 0.05 to 0.95.")


def ready(log: "Log", model_path: Path | None, method: str, learn: float, seed: int) -> Ready:
    """Load the model; without one, fit on the log's own beginning and judge the rest."""
    check_learn(learn)
    if model_path is not None:
        from sensorfault.runtime.store import load

        model = load(model_path)
        return Ready(model, log, None, limits(model))
    from sensorfault.methods.fit import fit

    start = float(log.time[0])
    cut = start + learn * log.duration_s
    with show.progress() as bar:
        task = bar.add_task(f"fitting {method}", total=None)
        model = fit(log.between(end_s=cut), method, held_out=0.0, seed=seed)
        bar.update(task, total=1, completed=1)
    result = own_limits(model, start, cut)
    for sentence in result:
        show.say(sentence)
    return Ready(model, log.between(cut), (start, cut), result)


def own_limits(model: "Model", start_s: float, end_s: float) -> tuple[str, ...]:
    """What it means that a model was fitted on the log that it judges."""
    return (
        f"No model was given: {model.method} was fitted on the log's own beginning, {show.clock(start_s)} to "
        f"{show.clock(end_s)}, taken as healthy; only the rest was judged.",
        "A fault in that beginning is learned, not found, and the false-alarm rate is not known: "
        "fit on a drive you trust with 'sensorfault fit' to know both.",
        *suspects(model),
        *not_watched(model),
    )


def limits(model: "Model") -> tuple[str, ...]:
    """Where a stored model's limits come from, and what they leave out."""
    fitted = f"Limits: fitted by {model.method} on {model.summary.get('training_log', 'another log')}."
    return (fitted, *rate(model), *not_watched(model))


def rate(model: "Model") -> tuple[str, ...]:
    """What is known of the false-alarm rate."""
    result = model.summary
    if "alarms_per_hour" not in result:
        return ("False-alarm rate: not measured.",)
    return (
        f"False alarms: {result['held_out_alarms']} in the {result['held_out_s']:.0f} s held out from the fit, "
        f"{result['alarms_per_hour']:.3g} an hour; with 95 % confidence below {result['alarms_per_hour_below']:.3g}.",
    )


def watches(paths: list[str]) -> str:
    """What is watched; of very many the first."""
    many = f" and {len(paths) - WATCHED_SAID} more" if len(paths) > WATCHED_SAID else ""
    return f"Watches {', '.join(paths[:WATCHED_SAID])}{many}."


def smallest(model: "Model") -> tuple[str, ...]:
    """The smallest fault that can be seen, where the method knows it, and a warning where its gate sleeps."""
    steps = model.summary.get("smallest_step_m")
    if not steps:
        return ()
    said = ", ".join(f"{size:.1f} m {when}" for when, size in steps.items())
    warning = model.summary.get("inert")
    return (f"Smallest step found nine times of ten: {said}.", *([warning] if warning else []))


def suspects(model: "Model") -> tuple[str, ...]:
    """What of the training data was left out of the fit because it looked faulty."""
    found: list[dict[str, Any]] = model.summary.get("training_suspects", [])
    if not found:
        return ()
    said = "; ".join(
        f"{one['reason']} on {one['channel']}, {show.clock(one['start_s'])} to {show.clock(one['end_s'])}"
        for one in found[:SUSPECTS_SAID]
    )
    more = f" and {len(found) - SUSPECTS_SAID} more" if len(found) > SUSPECTS_SAID else ""
    return (f"Left out of the fit, since the training data look faulty there: {said}{more}.",)


def not_watched(model: "Model") -> tuple[str, ...]:
    """Which parts of the method this log does not allow, which channels are watched for silence only, and why."""
    parts: dict[str, str] = model.summary.get("cannot", {})
    said = tuple(f"Not running {part}: {reason}" for part, reason in parts.items())
    reasons: dict[str, str] = model.summary.get("not_watched", {})
    if not reasons:
        return said
    by_reason: dict[str, list[str]] = {}
    for path, reason in reasons.items():
        by_reason.setdefault(reason, []).append(path)
    silent = "; ".join(f"{', '.join(paths)} ({reason})" for reason, paths in by_reason.items())
    return (*said, f"Watched for silence only: {silent}.")


def detect(model: "Model", log: "Log", what: str = "judging") -> "Detection":
    """Detect with a progress bar."""
    from sensorfault.runtime.detect import detect

    with show.progress() as bar:
        task = bar.add_task(what, total=1.0)
        return detect(model, log, lambda share: bar.update(task, completed=share))


def answer(
    model: "Model",
    log: "Log",
    notes: Sequence[str],
    fitted_on_s: tuple[float, float] | None,
    events: "Sequence[Event]",
) -> dict[str, Any]:
    """The JSON of a detection. `log`: what was judged; its first row and its last are enough."""
    return {
        "log": log.name,
        "method": model.method,
        "judged_s": [float(log.time[0]), float(log.time[-1])],
        "fitted_on_s": fitted_on_s,
        "watched": [c.path for c, w in zip(model.channels, model.watched, strict=True) if w],
        "not_watched": model.summary.get("not_watched", {}),
        "notes": list(notes),
        "events": [event.as_dict() for event in events],
    }
