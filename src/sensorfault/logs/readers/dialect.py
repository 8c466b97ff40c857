"""How a text table is written: delimiter, comments, header, units, first and last whole row."""

import re
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from sensorfault.logs.readers.cells import has_decimal_comma, is_number, is_valued
from sensorfault.logs.readers.header import header_of
from sensorfault.logs.readers.records import Record, some_records, usual_width
from sensorfault.logs.readers.text import Text, beginning
from sensorfault.logs.table import LogError

_DELIMITERS = (",", ";", "\t", "|")
_COMMENTS = ("#", "%", "//")
_DATE = re.compile(r"[\d:./TZ+-]+")
_VOTERS = 200  # lines that vote, the last ones of the beginning: above them may stand anything
_EVEN = 0.95  # share of the records that have the usual number of cells, unless there are several kinds
_KINDS, _OF_KIND = 16, 3  # most kinds, and fewest records of one, in the beginning


@dataclass(frozen=True)
class Dialect:
    """`delimiter` None: any run of blanks. `skip`: lines before the first row. `names`: one for each column.

    `units`: what the header says of the columns beside their names. `unnamed`: columns that the header does not name.
    `kinds`: whether the rows are records of several kinds, which the first cell names, each with cells of its own.
    """

    delimiter: str | None
    names: tuple[str, ...]
    skip: int
    decimal_comma: bool
    comment: str | None
    headerless: bool
    first_cut: bool
    text: Text = field(repr=False)
    units: tuple[str, ...] = ()
    unnamed: frozenset[str] = frozenset()
    kinds: bool = False

    def split(self, line: str) -> list[str]:
        """The cells of one line, without quotes and blanks."""
        return next((list(one.cells) for one in some_records([(1, line)], self.delimiter)), [])


def sniff(path: Path) -> Dialect:
    """Read the beginning and say how the table is written.

    Raises:
        LogError: empty, not text, no table with two columns or more, or a header that does not fit its rows.
    """
    text = beginning(path)
    comment = _comment(text.lines)
    lines = [(i, line) for i, line in enumerate(text.lines, 1) if line.strip()]
    rows = [(i, line) for i, line in lines if not (comment and line.lstrip().startswith(comment))]
    if not rows:
        raise LogError(f"{path}: the file holds comments only; name a log with rows.")
    delimiter = _delimiter(rows[-_VOTERS:])
    table = some_records(rows, delimiter)
    width, votes = usual_width(table[-_VOTERS:])
    if width < 2:
        raise LogError(
            f"{path}: a log needs a time column and one more, but its lines have one cell; check its delimiter."
        )
    comments = [
        record
        for i, line in lines
        if comment and line.lstrip().startswith(comment)
        for record in _remark(i, line.lstrip().removeprefix(comment), delimiter, width)
    ]
    voters = table[-_VOTERS:]
    if votes < _EVEN * len(voters) <= _votes(voters):
        return Dialect(delimiter, (), 0, _decimal(table, delimiter), comment, True, False, text, kinds=True)
    return _described(path, text, comment, delimiter, table, comments, width)


def _described(
    path: Path,
    text: Text,
    comment: str | None,
    delimiter: str | None,
    table: list[Record],
    comments: list[Record],
    width: int,
) -> Dialect:
    found = header_of(table, comments, width)
    if found is None:
        raise LogError(f"{path}: there is a header, but no row below it; name a log with rows.")
    if found.wrong:
        raise LogError(
            f"{path}: {found.wrong}; name each column in the header, or put quotes around cells with commas."
        )
    cut = found.headless and table[0].line < found.first.line and len(table[0].cells) < width
    names = unique(found.names)
    unnamed = frozenset(name for name, said in zip(names, found.names, strict=True) if not (said or found.headless))
    return Dialect(
        delimiter,
        names,
        found.first.line - 1,
        _decimal([record for record in table if record.line >= found.first.line], delimiter),
        comment,
        found.headless,
        cut,
        text,
        found.units,
        unnamed,
    )


def _comment(lines: Sequence[str]) -> str | None:
    """What begins a line of comment, if some lines begin so."""
    return next((mark for line in lines for mark in _COMMENTS if line.lstrip().startswith(mark)), None)


def _remark(number: int, line: str, delimiter: str | None, width: int) -> list[Record]:
    """A line of comment as a record: "%time,x,y", or "# Time [s]    range [m]", of words with blanks inside."""
    found = some_records([(number, line)], delimiter)
    if found and len(found[0].cells) == width:
        return found
    apart = tuple(cell.strip() for cell in line.replace("\t", "  ").strip().split("  ") if cell.strip())
    return [Record(number, number, apart)] if len(apart) == width else []


def _delimiter(lines: list[tuple[int, str]]) -> str | None:
    """The delimiter that splits most lines into the same number of cells, at least two.

    Of equals, the one whose cells are numbers: "1,5;2,5" falls into even pieces at either. Blanks must be clearly
    better: "2024-01-01 10:00,1.5" has one in every line too, and "1,5 2,5" has commas.
    """
    ranked = [(*_evenness(lines, delimiter), delimiter) for delimiter in _DELIMITERS]
    votes, share, best = max(ranked, key=lambda rank: rank[:2])
    blanks, numbers = _evenness(lines, None)
    return None if blanks > 1.2 * votes or (blanks > 0.9 * votes and numbers > share + 0.3) else best


def _evenness(lines: list[tuple[int, str]], delimiter: str | None) -> tuple[int, float]:
    """How many lines fall into the usual number of cells, and the share of numbers and dates among their cells."""
    rows = some_records(lines, delimiter)
    width, _ = usual_width(rows)
    if width < 2:
        return 0, 0.0
    cells = [cell for row in rows for cell in row.cells]
    return _votes(rows), sum(is_number(cell) or _DATE.fullmatch(cell) is not None for cell in cells) / len(cells)


def _votes(rows: Sequence[Record]) -> int:
    """How many records have the usual number of cells, or the usual number of the kind that their first cell names."""
    widths: dict[str, Counter[int]] = defaultdict(Counter)
    for row in rows:
        widths[row.cells[0]][len(row.cells)] += 1
    of_kind = sum(count.most_common(1)[0][1] for count in widths.values())
    kinds = 1 < len(widths) <= _KINDS and all(count.total() >= _OF_KIND for count in widths.values())
    return max(usual_width(rows)[1], of_kind if kinds and not any(is_valued(kind) for kind in widths) else 0)


def _decimal(table: Sequence[Record], delimiter: str | None) -> bool:
    return has_decimal_comma(cell for record in table for cell in record.cells if delimiter != "," or "," in cell)


def unique(names: Sequence[str]) -> tuple[str, ...]:
    """Names, c1, c2, ... where there is none, and a number behind one that was there before."""
    seen: Counter[str] = Counter()
    unique = []
    for i, name in enumerate(names):
        name = name or f"c{i + 1}"
        seen[name] += 1
        unique.append(name if seen[name] == 1 else f"{name}_{seen[name]}")
    return tuple(unique)
