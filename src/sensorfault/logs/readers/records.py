"""Lines of text become records of cells, with quotes as RFC 4180 has them."""

import csv
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

_TOKEN = re.compile(r'"((?:[^"]|"")*)"|(\S+)')


@dataclass(frozen=True)
class Record:
    """One record. `line`: its first line, counted from 1; `last`: its last one, as a cell may hold line breaks."""

    line: int
    last: int
    cells: tuple[str, ...]


def records(lines: Iterable[tuple[int, str]], delimiter: str | None) -> Iterator[Record]:
    """The records of numbered lines; `delimiter` None: any run of blanks.

    Raises:
        csv.Error: a cell is longer than any should be, as its quote does not close.
    """
    if delimiter is None:
        for number, line in lines:
            found = tuple((quoted or bare).strip() for quoted, bare in _TOKEN.findall(line))
            yield Record(number, number, found)
        return
    numbers: list[int] = []

    def seen() -> Iterator[str]:
        for number, line in lines:
            numbers.append(number)
            yield line.replace("\r", " ") + "\n"

    for cells in csv.reader(seen(), delimiter=delimiter, skipinitialspace=True):
        yield Record(numbers[0], numbers[-1], tuple(cell.strip() for cell in cells))
        numbers.clear()


def some_records(lines: Iterable[tuple[int, str]], delimiter: str | None) -> list[Record]:
    """The same, up to a cell that is too long."""
    found = []
    try:
        for record in records(lines, delimiter):
            found.append(record)  # noqa: PERF402
    except csv.Error:
        pass
    return found


def usual_width(found: Sequence[Record]) -> tuple[int, int]:
    """The usual number of cells, and how many records have it."""
    counts = Counter(len(record.cells) for record in found)
    return counts.most_common(1)[0] if counts else (0, 0)
