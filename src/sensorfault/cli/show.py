"""What a person sees: progress and sentences on stderr, tables on stdout, JSON where it was asked for."""

import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from sensorfault.cli import cells

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

    from sensorfault.events.event import Event


@cache
def _stderr() -> "Console":
    """One console for all that goes to stderr, so that bars and sentences know of each other."""
    from rich.console import Console

    return Console(stderr=True)


def say(sentence: str) -> None:
    """Print one sentence on stderr, so that tables and JSON stay clean."""
    _stderr().print(plain_text(sentence), markup=False, highlight=False, soft_wrap=True)


def plain_text(text: str) -> str:
    """A text in which control characters, as a name of a column may have them, are seen and not obeyed."""
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


@contextmanager
def progress() -> Iterator["Progress"]:
    """Show progress bars on stderr, one line a task."""
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=_stderr(), transient=False) as bar:
        yield bar


_PATIENCE_S = 0.5  # shorter work needs no bar


@contextmanager
def patient(doing: str) -> Iterator[Callable[[float], None]]:
    """A progress bar that appears only if the work takes long. Yields what sets the share done, 0 to 1."""
    begun = monotonic()
    with ExitStack() as later:
        shown: list[Callable[[float], None]] = []

        def update(share: float) -> None:
            if monotonic() < begun + _PATIENCE_S:
                return
            if not shown:
                bar = later.enter_context(progress())
                task = bar.add_task(doing, total=1.0)
                shown.append(lambda share: bar.update(task, completed=share))
            shown[0](share)

        yield update


SHOWN = 14  # events: an answer is at most a screen
_NUMBERS = {"peak", "limit", "n", "recall", "chance", "magnitude"}  # columns


def table(
    title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], answer: bool = True, right: Sequence[str] = ()
) -> None:
    """Print a table on stdout, or on stderr if `answer` is False. `right`: more columns of numbers."""
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
        drawn.add_row(*(Text(plain_text(cell)) for cell in row))
    stream = sys.stdout if answer else sys.stderr
    width = None if stream.isatty() else 200
    Console(file=stream, width=width, highlight=False).print(drawn)


def heading(text: str, answer: bool = True) -> None:
    """Print a line above a table, where the table goes; it is not wrapped where the table is narrow."""
    from rich.console import Console
    from rich.text import Text

    Console(file=sys.stdout if answer else sys.stderr, soft_wrap=True).print(Text(f"\n{text}", "bold"))


def events(found: "Sequence[Event]", title: str, answer: bool = True) -> None:
    """Print the events as a table, or one sentence if there are none."""
    if found:
        rows = [cells.event_row(event) for event in found]
        columns: tuple[str, ...] = cells.EVENT_COLUMNS
        if any(event.found_by for event in found):
            columns, rows = (
                (*columns, "found by"),
                [(*row, e.found_by or "") for row, e in zip(rows, found, strict=True)],
            )
        if len(rows) > SHOWN and answer:
            say(f"{len(rows)} events; the first {SHOWN} are shown, all are in --json and --out.")
            rows = rows[:SHOWN]
        table(title, columns, rows, answer)
    else:
        say(f"{title}: none.")


def write_json(path: str | None, answer: Mapping[str, Any]) -> None:
    """Write JSON to a file, whole or not at all, or to stdout (`-`); do nothing without a path."""
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
