"""Write fault events to a file; its name says which format."""

from collections.abc import Callable, Sequence
from pathlib import Path

from sensorfault.core.expect import EVENTS, LOG, expect, expect_all, expect_path
from sensorfault.core.extras import require
from sensorfault.core.files import appearing
from sensorfault.events.event import Event
from sensorfault.events.export import bags, mcap, tables
from sensorfault.logs.table import Log, LogError

Writer = Callable[[Sequence[Event], Log, Path, Path | None], None]

KINDS: dict[str, Writer] = {
    ".jsonl": tables.write_jsonl,
    ".csv": tables.write_csv,
    ".parquet": tables.write_parquet,
    ".mcap": mcap.write_mcap,
    ".bag": bags.write_bag1,
    "": bags.write_bag2,
}
_NEEDS = {".csv": "polars", ".parquet": "polars", ".mcap": "foxglove", ".bag": "rosbags", "": "rosbags"}
_WORDS = ".jsonl, .csv, .parquet, .mcap (annotations), .bag (ROS 1) or a new folder (ROS 2 bag)"


def check(path: Path) -> None:
    """Check, before the work is done, that events can be written to this path.

    Raises:
        LogError: an unknown format, or a folder that exists already.
        MissingLibrary: this kind of file needs a library that is not installed.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise LogError(f"{path}: events are written as {_WORDS}, not as '{path.suffix}'; give another name.")
    if kind in _NEEDS:
        require(f"{path}: writing it", _NEEDS[kind])
    if kind == "" and path.exists():
        raise LogError(f"{path} exists already; give a new folder for the bag, or a file with one of {_WORDS}.")


def write_events(events: Sequence[Event], log: Log, path: str | Path, source: Path | None = None) -> None:
    """Write events to a file, whole or not at all.

    Args:
        events: the events of one log, with times in seconds of the log.
        log: the log they were found in. If it knows Unix time, messages in recordings have it; else they start at 0.
        path: .jsonl, .csv, .parquet; .mcap for annotations; .bag for ROS 1, or a new folder for a ROS 2 bag, of
            diagnostic_msgs/DiagnosticArray.
        source: for .mcap: a recording whose messages are copied beside the annotations.

    Raises:
        LogError: as `check` says, or the folder cannot be written to.
        MissingLibrary: as `check` says.
        TypeError: something else than events, a log or a path.
    """
    expect_all(events, Event, "write_events: events", EVENTS)
    expect(log, Log, "write_events: log", LOG)
    expect_path(path, "write_events: path")
    path = Path(path)
    check(path)
    writer = KINDS[path.suffix.lower()]
    if path.suffix:
        with appearing(path) as temporary:
            writer(events, log, temporary, source)
    else:
        bags.appear(path, lambda folder: writer(events, log, folder, source))
