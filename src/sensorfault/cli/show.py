"""What a person sees: progress and notes on stderr, tables on stdout; JSON where it is asked for."""

import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.progress import Progress

    from sensorfault.events.event import Event
    from sensorfault.faults.fault import Fault


def say(sentence: str) -> None:
    """One sentence for people, on stderr so that tables and JSON stay clean."""
    from rich.console import Console

    Console(stderr=True, highlight=False, soft_wrap=True).print(sentence, markup=False)


@contextmanager
def progress() -> Iterator["Progress"]:
    """A progress display on stderr; one line a task."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=False) as bar:
        yield bar


_PATIENCE_S = 0.5  # nobody needs to see how a small file is read


@contextmanager
def reading(name: str) -> Iterator[Callable[[float], None]]:
    """What hears the share of a file that has been read; the display appears where that takes its time."""
    begun = monotonic()
    with ExitStack() as later:
        shown: list[Callable[[float], None]] = []

        def tell(share: float) -> None:
            if monotonic() < begun + _PATIENCE_S:
                return
            if not shown:
                bar = later.enter_context(progress())
                task = bar.add_task(f"reading {name}", total=1.0)
                shown.append(lambda share: bar.update(task, completed=share))
            shown[0](share)

        yield tell


def table(
    title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], answer: bool = True, right: Sequence[str] = ()
) -> None:
    """A table on stdout; on stderr when JSON has stdout (`answer` False). `right`: more columns of numbers."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    drawn = Table(
        title=Text(title, "table.title") if title else None,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
    )
    for name in columns:
        drawn.add_column(
            Text(name), justify="right" if name.endswith(("]", "%")) or name in (*_NUMBERS, *right) else "left"
        )
    for row in rows:
        drawn.add_row(*(Text(cell) for cell in row))
    stream = sys.stdout if answer else sys.stderr
    width = None if stream.isatty() else 200
    Console(file=stream, width=width, highlight=False).print(drawn)


def heading(text: str, answer: bool = True) -> None:
    """A line above a table, where the table goes; not broken where the table is narrow."""
    from rich.console import Console
    from rich.text import Text

    Console(file=sys.stdout if answer else sys.stderr, soft_wrap=True).print(Text(f"\n{text}", "bold"))


_NUMBERS = {"peak", "limit", "n", "recall", "chance", "magnitude"}


def clock(seconds: float | None) -> str:
    """Seconds as m:ss.cc; an open end as a word."""
    if seconds is None:
        return "goes on"
    minutes, rest = divmod(round(seconds, 2), 60)
    return f"{int(minutes)}:{rest:05.2f}"


def number(value: float | None, digits: int = 3) -> str:
    """A few digits, nothing for None and NaN."""
    return "" if value is None or not math.isfinite(value) else f"{value:.{digits}g}"


def percent(value: float) -> str:
    """A share as a whole percentage, nothing for NaN."""
    return "" if not math.isfinite(value) else f"{100 * value:.0f}"


EVENT_COLUMNS = ("start", "end", "sensor", "channel", "kind", "peak", "limit")


def event_row(event: "Event") -> tuple[str, ...]:
    """One event as a row of EVENT_COLUMNS."""
    nobody = "the whole log" if event.kind == "missing" else "unknown which"
    sensor = "vehicle motion" if event.subject == "motion" else event.sensor or nobody
    channel = event.channel or ("" if event.sensor is None else "all")
    ends = clock(event.start_s), clock(event.end_s)
    return (*ends, sensor, channel, event.kind, number(event.peak_score), number(event.limit))


def events(found: "Sequence[Event]", title: str, answer: bool = True) -> None:
    """The events as a table, or one sentence that there are none."""
    if found:
        table(title, EVENT_COLUMNS, [event_row(event) for event in found], answer)
    else:
        say(f"{title}: none.")


def fault_words(fault: "Fault") -> str:
    """An injected fault in a few words."""
    from sensorfault.faults.fault import OFFSETS

    where = f"{fault.sensor}.{fault.channel}" if fault.channel else fault.sensor
    unit = " sigma" if fault.sigmas else ""
    size = f" {fault.magnitude:g}{unit}" if fault.kind in OFFSETS or fault.kind in ("scale", "delay") else ""
    return f"{fault.kind}{size} on {where}"


def write_json(path: str | None, answer: Mapping[str, Any]) -> None:
    """Write JSON to a file (whole or not at all) or to stdout (`-`); nothing without a path."""
    if path is None:
        return
    from sensorfault.evaluation.plain import plain

    text = json.dumps(plain(answer), indent=1, allow_nan=False) + "\n"
    if path == "-":
        sys.stdout.write(text)
        return
    from sensorfault.core.files import appearing

    with appearing(Path(path)) as temporary:
        temporary.write_text(text)
