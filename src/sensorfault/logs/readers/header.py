"""The header of a text table: which line has the names, what stands above and below it."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from sensorfault.logs.dates import form_of_cells
from sensorfault.logs.readers.cells import MISSING, is_valued
from sensorfault.logs.readers.records import Record
from sensorfault.logs.time_units import TIME_WORDS
from sensorfault.logs.units import known

_MANY = 0.8
_TYPES = re.compile(r"u?int(8|16|32|64)?|float(32|64)?|double|single|string|str|bool(ean)?|char|number|numeric|text")
_NO_UNIT = (
    "",
    "-",
    "1",
    "none",
    "n/a",
    "na",
    "unitless",
    "dimensionless",
    "bool",
    "count",
    "counts",
    "#",
    "raw",
    "lsb",
)


@dataclass(frozen=True)
class Header:
    """`names`: one for each column, "" for one without. `units`: by name, as the file spells them.

    `first`: the first record of the rows. `wrong`: why the names do not fit the rows, if they do not.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    first: Record
    headless: bool
    wrong: str = ""


def header_of(table: Sequence[Record], comments: Sequence[Record], width: int) -> Header | None:
    """The header above the rows of a table; None if it has no row. `comments`: lines of comment, as records."""
    body = [record for record in table if len(record.cells) == width]
    valued = _valued(body[len(body) // 2 :], width)
    at = next((i for i, record in enumerate(table) if _is_row(record, valued, width)), len(table))
    if not valued:  # a table of words
        at = 1 if table and _are_names(table[0].cells) else 0
    if at >= len(table):
        return None
    first = table[at]
    above = [record for record in table[:at] if _are_names(record.cells)]
    remarks = [one for one in comments if one.last < first.line and _are_names(one.cells) and len(one.cells) > 1]
    units: tuple[str, ...] = ()
    lowest = above[-1] if above else None
    while above and (_are_units(above[-1].cells) or _are_types(above[-1].cells)) and len(above) > 1:
        units = above[-1].cells if _are_units(above[-1].cells) else units
        above.pop()
    if not above or len(above[-1].cells) < max(2, width / 2):  # a title is no header
        above = [one for one in remarks if len(one.cells) == width]
        while len(above) > 1 and _are_units(above[-1].cells):
            units = above.pop().cells
    if not above:
        return Header(("",) * width, (), first, True)
    if lowest is not None and above[-1] in table:
        first = table[table.index(lowest) + 1]  # a row that is unlike the others is counted later
    cells = above[-1].cells
    group = above[-2].cells if len(above) > 1 else ()
    names, wrong = _aligned(_grouped(cells, group), body, width)
    return Header(names, _aligned(units, body, width)[0] if units else (), first, False, wrong)


def _valued(body: Sequence[Record], width: int) -> list[int]:
    """The columns whose cells hold values, not words."""
    found = []
    for i in range(width):
        cells = [record.cells[i] for record in body if record.cells[i] not in MISSING]
        if cells and sum(is_valued(cell) for cell in cells) >= _MANY * len(cells):
            found.append(i)
    return found


def _is_row(record: Record, valued: Sequence[int], width: int) -> bool:
    if len(record.cells) != width:
        return False
    cells = [record.cells[i] for i in valued if record.cells[i] not in MISSING]
    return sum(is_valued(cell) for cell in cells) > len(cells) / 2 if cells else False


def _are_names(cells: Sequence[str]) -> bool:
    """Names, not values: hardly a cell is a number, and not all are blank."""
    filled = [cell for cell in cells if cell]
    words = [cell for cell in filled if re.search(r"[^\W\d]", cell) and not _is_value(cell)]
    return bool(words) and len(words) >= _MANY * len(filled)


def _is_value(cell: str) -> bool:
    return cell.lower() in ("nan", "inf") or (is_valued(cell) and cell not in MISSING and cell[0] not in "#°µ%")


def _are_units(cells: Sequence[str]) -> bool:
    bare = [cell.strip("[]() ") for cell in cells]
    found = [cell for cell in bare if cell and (known(cell) or cell in TIME_WORDS)]
    like = [cell for cell in bare if cell.lower() in _NO_UNIT or known(cell) or cell in TIME_WORDS]
    framed = [cell for cell in cells if not cell or (cell[0] + cell[-1]) in ("[]", "()")]
    return (len(framed) == len(cells) and any(cells)) or (bool(found) and len(like) >= _MANY * len(cells))


def _are_types(cells: Sequence[str]) -> bool:
    return all(_TYPES.fullmatch(cell.lower()) for cell in cells)


def _grouped(cells: Sequence[str], group: Sequence[str]) -> tuple[str, ...]:
    """Names that occur twice, under the headings of their groups: X, Y, Z under Accelerometer and Gyroscope."""
    if len(group) != len(cells) or max(Counter(filter(None, cells)).values(), default=0) < 2:
        return tuple(cells)
    headed, heading = [], ""
    for cell, above in zip(cells, group, strict=True):
        heading = above or heading
        headed.append(f"{heading}.{cell}" if heading and cell else cell or heading)
    return tuple(headed)


def _aligned(cells: Sequence[str], body: Sequence[Record], width: int) -> tuple[tuple[str, ...], str]:
    """One name for each column; else what is wrong."""
    names = list(cells)
    while len(names) > width and not names[-1]:
        names.pop()
    missing = width - len(names)
    if missing == 0:
        return tuple(names), ""
    if missing > 0 and not any(cell for record in body for cell in record.cells[len(names) :]):
        return (*names, *("",) * missing), ""
    if missing == 1 and _counts([record.cells[0] for record in body]):
        return ("", *names), ""  # R and others write no name above the numbers of the rows
    split = _date_and_clock(body[-1].cells)
    if missing == 1 and split is not None and split < len(names):
        return (*names[: split + 1], f"{names[split]}_clock", *names[split + 1 :]), ""
    wrong = f"the header has {len(names)} names, but the rows have {width} cells"
    return (*names[:width], *("",) * max(0, missing)), wrong


def _counts(cells: Sequence[str]) -> bool:
    if not all(cell.isdigit() for cell in cells) or len(cells) < 2:
        return False
    return all(int(two) - int(one) == 1 for one, two in pairwise(cells))


def _date_and_clock(cells: Sequence[str]) -> int | None:
    """Where a date stands in front of a clock."""
    forms = [form_of_cells([cell]) if is_valued(cell) else None for cell in cells]
    for i, (one, two) in enumerate(pairwise(forms)):
        if one and two and one.has_day and not one.has_clock and two.has_clock and not two.has_day:
            return i
    return None
