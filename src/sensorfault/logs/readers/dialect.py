"""How a text table is written: delimiter, comments, header, first and last whole row."""

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from sensorfault.logs.table import LogError

_HEAD_BYTES = 1 << 16
_COMMENT = b"#%"
_DELIMITERS = (",", ";", "\t", "|")
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
MISSING = ("", "NA", "N/A", "NULL", "null", "None", "none", "-")  # cells that mean no value


@dataclass(frozen=True)
class Dialect:
    """`delimiter` None: any run of blanks. `skip`: lines before the first row. `names`: one for each column."""

    delimiter: str | None
    names: tuple[str, ...]
    skip: int
    decimal_comma: bool
    comment: str | None
    headerless: bool
    first_cut: bool

    def split(self, line: str) -> list[str]:
        """The cells of one line, without quotes and blanks."""
        return [cell.strip().strip('"') for cell in line.strip().split(self.delimiter)]


def is_number(cell: str) -> bool:
    """Whether the cell reads as a number; a decimal comma is one too."""
    return _NUMBER.fullmatch(cell) is not None


def sniff(path: Path) -> Dialect:
    """Read the first 64 kB and say how the table is written.

    Raises:
        LogError: empty, not text, or no table with two columns or more.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    if not head.strip():
        raise LogError(f"{path}: the file is empty; name a log with a header and rows.")
    if b"\0" in head or sum(byte < 9 or 13 < byte < 32 for byte in head) > len(head) // 100:
        raise LogError(f"{path}: this is not text although its name says so; export the log as CSV or Parquet.")
    lines = head.decode("utf-8-sig", "replace").splitlines()
    if len(head) == _HEAD_BYTES and len(lines) > 1:
        lines.pop()  # cut by us, not by the file
    comment = next((line.lstrip()[0] for line in lines if line.lstrip()[:1].encode() in (b"#", b"%")), None)
    table = [i for i, line in enumerate(lines) if line.strip() and not (comment and line.lstrip().startswith(comment))]
    if not table:
        raise LogError(f"{path}: the file holds comments only; name a log with rows.")
    delimiter = _delimiter([lines[i] for i in table])
    dialect = Dialect(delimiter, (), 0, False, comment, False, False)
    cells = {i: dialect.split(lines[i]) for i in table}
    width = Counter(len(row) for row in cells.values()).most_common(1)[0][0]
    if width < 2:
        raise LogError(
            f"{path}: a log needs a time column and one more, but its lines have one cell; check its delimiter."
        )
    return _with_header(path, dialect, lines, table, cells, width)


def _delimiter(lines: list[str]) -> str | None:
    """The delimiter that splits most lines into the same number of cells, at least two.

    Of equals, the one whose cells are numbers: "1,5;2,5" falls into even pieces at either. Blanks must be clearly
    better: "2024-01-01 10:00,1.5" has one in every line too.
    """
    lines = lines[:200]
    ranked = [(*_evenness(lines, delimiter), delimiter) for delimiter in _DELIMITERS]
    votes, _, best = max(ranked, key=lambda rank: rank[:2])
    blanks, _ = _evenness(lines, None)
    return None if blanks > 1.2 * votes else best


def _evenness(lines: list[str], delimiter: str | None) -> tuple[int, float]:
    """How many lines fall into the usual number of cells, and the share of numbers among their cells."""
    rows = [[cell.strip() for cell in line.split(delimiter)] for line in lines]
    width, votes = Counter(len(row) for row in rows).most_common(1)[0]
    if width < 2:
        return 0, 0.0
    return votes, sum(is_number(cell) for row in rows for cell in row) / sum(len(row) for row in rows)


def _with_header(
    path: Path, dialect: Dialect, lines: list[str], table: list[int], cells: dict[int, list[str]], width: int
) -> Dialect:
    first = table[0]
    names: list[str] = []
    first_cut = False
    above = [line.lstrip()[1:] for line in lines[:first] if line.strip()]
    if _is_header(cells[first]) and len(cells[first]) <= width:
        names, start = cells[first], first + 1
    elif above and (commented := _above(dialect, above[-1], width)):
        names, start = commented, first
    elif len(cells[first]) < width and len(table) > 1:
        start, first_cut = first + 1, True  # recording began in the middle of a line
    else:
        start = first
    headerless = not names
    names += [f"c{i + 1}" for i in range(len(names), width)]
    row = next((cells[i] for i in table if i >= start and len(cells[i]) == width), None)
    if row is None:
        raise LogError(f"{path}: there is a header, but no row below it; name a log with rows.")
    comma = dialect.delimiter != "," and any("," in cell and is_number(cell) for cell in row)
    return Dialect(dialect.delimiter, _unique(names), start, comma, dialect.comment, headerless, first_cut)


def _above(dialect: Dialect, line: str, width: int) -> list[str]:
    """The names in a comment above the rows: "%time,x,y", or "# Time [s]    range [m]", of words with blanks inside."""
    for cells in (dialect.split(line), re.split(r"\t|\s{2,}", line.strip())):
        if len(cells) == width and _is_header(cells):
            return cells
    return []


def _is_header(cells: list[str]) -> bool:
    """Names, not values: no cell is a number, and not all are blank."""
    return not any(is_number(cell) for cell in cells) and any(re.search(r"[^\W\d]", cell) for cell in cells)


def _unique(names: list[str]) -> tuple[str, ...]:
    seen: Counter[str] = Counter()
    unique = []
    for i, name in enumerate(names):
        name = name or f"c{i + 1}"
        seen[name] += 1
        unique.append(name if seen[name] == 1 else f"{name}_{seen[name]}")
    return tuple(unique)
