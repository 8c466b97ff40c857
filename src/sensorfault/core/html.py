"""Small tables for notebooks: escaped, without scripts, other files or colours, so that every theme suits them."""

from collections.abc import Sequence
from html import escape

MOST = 20  # rows that are shown


def page(caption: str, *tables: str) -> str:
    """A line of text above tables."""
    return f"<div><p><b>{escape(caption)}</b></p>{''.join(tables)}</div>"


def table(heads: Sequence[str], rows: Sequence[Sequence[object]], most: int = MOST) -> str:
    """A table; of more than `most` rows only the first, and how many others there are."""
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    body = "".join(_row(row) for row in rows[:most])
    more = f"<p>and {len(rows) - most:,} more</p>" if len(rows) > most else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _row(cells: Sequence[object]) -> str:
    return "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>"


def number(value: float | None) -> str:
    """Three digits, nothing where there is no number."""
    return "" if value is None else f"{value:.3g}"
