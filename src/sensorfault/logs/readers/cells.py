"""What the cells of a text table are: numbers, no value, or words."""

import re
from collections.abc import Iterable

import polars as pl

MISSING = (
    *("", "NA", "N/A", "n/a", "#N/A", "NULL", "null", "Null", "(null)", "None", "none", "nil", "-", "--", "---", "?"),
    *("NAN", "-nan", "-nan(ind)", "nan(ind)", "-1.#IND", "1.#QNAN", "#NUM!", "#DIV/0!", "#VALUE!"),
)
PADDING = " \t\r\"'"
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
_GROUPED = re.compile(
    r"[+-]?[1-9]\d{0,2}(([' \u00a0\u202f])\d{3}(\2\d{3})*([.,]\d*)?|(,\d{3})+(\.\d*)?|(\.\d{3})+(,\d*)?)"
)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
_VALUE = re.compile(r"[+-]?[.,]?\d|[+-]?(∞|nan|inf)|#", re.IGNORECASE)
_MOSTLY = 0.5  # share of numbers that makes a column one of numbers
STAMP = r"^(19|20)\d\d[01]\d[0-3]\d[0-2]\d[0-5]\d[0-6]\d\.\d+$"  # 20240501100000.5: a float would round it
_POINTS = r"^[+-]?\d+\.\d*$"  # a decimal point
_GROUPS_COMMA = r"^[+-]?\d{1,3}(?:[.' \u{a0}\u{202f}]\d{3})+(?:,\d*)?$"
_GROUPS = r"^([+-]?\d{1,3})(?:[,' \u{a0}\u{202f}]\d{3})+(?:\.\d*)?$"


def is_number(cell: str) -> bool:
    """Whether the cell reads as a number; a decimal comma is one too, and so are groups of three digits."""
    return _NUMBER.fullmatch(cell) is not None or _GROUPED.fullmatch(cell) is not None


def is_valued(cell: str) -> bool:
    """Whether the cell holds a number, a date, or that there is no value; else it is a word."""
    return cell in MISSING or _VALUE.match(cell) is not None


def has_decimal_comma(cells: Iterable[str]) -> bool:
    """Whether the comma in these cells is the decimal sign; in "1,500" it may also part thousands."""
    commas = [cell for cell in cells if "," in cell and is_number(cell)]
    decimal = [cell for cell in commas if cell.rfind(",") > cell.rfind(".") and cell.count(",") == 1]
    sure = any(not _THOUSANDS.fullmatch(cell) for cell in decimal)
    return sure or (bool(decimal) and len(decimal) == len(commas))


def numbers_of(column: pl.Series, comma: bool = False) -> pl.Series:
    """A text column as numbers where most cells are; what is none is null. `comma`: the decimal sign is a comma."""
    text = column.str.strip_chars(PADDING)
    text = text.set(text.is_in(MISSING), None)
    known = len(text) - text.null_count()
    if known and text.str.contains(STAMP).all():
        return text
    comma = comma and (text.str.contains(",", literal=True) | ~text.str.contains(_POINTS)).any()
    number = (_spelled(text, True) if comma else text).cast(pl.Float64, strict=False)
    left = number.is_null() & text.is_not_null()
    if left.any() and not comma:
        number = number.zip_with(~left, _spelled(text, False).cast(pl.Float64, strict=False))
    lost = number.null_count() - text.null_count()
    return number if lost < _MOSTLY * known or not known else text


def _spelled(text: pl.Series, comma: bool) -> pl.Series:
    """Without what parts thousands, and with a point as decimal sign."""
    grouped = text.str.contains(_GROUPS_COMMA if comma else _GROUPS).fill_null(False)
    parts = r"[.' \u{a0}\u{202f}]" if comma else r"[,' \u{a0}\u{202f}]"
    plain = text.str.replace_all(parts, "").zip_with(grouped, text) if grouped.any() else text
    plain = plain.str.replace(",", ".", literal=True) if comma else plain
    return plain.str.replace("∞", "inf", literal=True)
