"""Read a log, whole or part by part, with progress, and print what reading found."""

import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import show
from sensorfault.core.times import clock

if TYPE_CHECKING:
    from sensorfault.faults.fault import Fault
    from sensorfault.logs import Log
    from sensorfault.logs.reading_notes import ReadingNotes
    from sensorfault.logs.vehicle import VehicleFile


NOTES_SHOWN = 8  # of what reading found; where a file is damaged comes first


def in_parts(path: Path, wanted: bool | None) -> bool:
    """Whether to read a log part by part: as the user wants; by default if it is long and its format allows it."""
    from sensorfault.logs.parts import is_long_log

    return is_long_log(path) if wanted is None else wanted


def read_log(
    path: Path,
    vehicle: Path | None,
    model: "VehicleFile | None" = None,
    quiet: bool = False,
    rate_hz: float | None = None,
) -> "Log":
    """Read a log whole. `model`: what a model knows of its columns. `quiet`: what reading found was printed before.

    `rate_hz`: rows a second of tables without a clock.

    Raises:
        LogError: as `read`, or the log is larger than this machine's memory.
    """
    from sensorfault.logs import read

    _check_memory(path)
    with show.patient(f"reading {path.name}") as tell:
        log = read(path, vehicle, tell=tell, model=model, rate_hz=rate_hz)
    if not quiet:
        _print(f"{log.name}: {len(log)} rows, {log.duration_s:.1f} s, {len(log.sensors)} sensors.", log.notes)
    return log


def read_in(
    parts: bool,
    path: Path,
    vehicle: Path | None,
    take: "Callable[[Log], None]",
    tell: Callable[[float], None] = lambda share: None,
    model: "VehicleFile | None" = None,
    quiet: bool = False,
    rate_hz: float | None = None,
) -> "ReadingNotes":
    """Read a log in parts, or else whole as one part. `take` gets each part, `tell` before it the share read so far.

    Raises:
        LogError: as `read_log` and `read_parts`.
    """
    from sensorfault.logs.parts import read_parts
    from sensorfault.logs.reading_notes import ReadingNotes

    if not parts:
        log = read_log(path, vehicle, model, quiet, rate_hz)
        tell(1.0)
        take(log)
        return ReadingNotes(log.notes, log.damage)

    rows, end_s, name = 0, 0.0, path.name

    def count(part: "Log") -> None:
        nonlocal rows, end_s, name
        rows, end_s, name = rows + len(part), float(part.time[-1]), part.name
        take(part)

    with show.patient(f"reading {path.name}") as bar:

        def both(share: float) -> None:
            bar(share)
            tell(share)

        said = read_parts(path, count, vehicle, both, model, rate_hz)
    if not quiet:
        _print(f"{name}: {rows} rows to {clock(end_s)}, read part by part.", said.notes)
    return said


def read_truth(path: Path) -> "tuple[Fault, ...]":
    """The faults that `inject` put into a log.

    Raises:
        FaultError: the file does not hold them.
    """
    from sensorfault.faults.fault import FaultError
    from sensorfault.faults.text import truth_from_json

    try:
        return truth_from_json(path.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise FaultError(f"{path}: not a text file; give the .truth.json that 'inject' wrote.") from None


def _check_memory(path: Path) -> None:
    from sensorfault.logs import LogError
    from sensorfault.logs.place import files_of

    size, memory = sum(file.stat().st_size for file in files_of(path)), _memory()
    if size > memory:
        raise LogError(
            f"{path}: {size / 1e9:.3g} GB cannot be read whole in {memory / 1e9:.3g} GB of memory; give a shorter log, "
            "or let detect, report and info read one file of most formats part by part (--by-parts)."
        )


def _memory() -> float:
    """Memory of this machine [bytes]; infinite where the system does not say."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return math.inf


def _print(summary: str, notes: Sequence[str]) -> None:
    show.say(summary)
    most = None if _is_info() else NOTES_SHOWN
    for note in notes[:most]:
        show.say(f"  {note}")
    if most is not None and len(notes) > most:
        show.say(f"  {len(notes) - NOTES_SHOWN} more notes: 'sensorfault info' and --json have all.")


def _is_info() -> bool:
    """Whether the verb is the one that is asked for all that reading found."""
    context = click.get_current_context(silent=True)
    return context is not None and context.info_name == "info"
