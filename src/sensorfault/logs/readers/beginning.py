"""Long files, and their first parts, which show what they hold."""

from collections.abc import Callable
from functools import reduce
from pathlib import Path

from sensorfault.logs.readers.formats import format_of, read_tables
from sensorfault.logs.readers.source import Ask, Tables, joined, with_notes

LONG = 10**9  # bytes
_PARTS = 8


def is_long(path: Path) -> bool:
    """Whether a log is better read part by part: its format can be, and its files are larger than LONG together."""
    form = format_of(path) if path.is_file() else None
    if form is None or not form.parts:
        return False
    files = (file for file in path.parent.iterdir() if form.may_be(file) and form.leader(file) == path)
    return sum(file.stat().st_size for file in files) > LONG


def read_beginning(path: Path, tell: Callable[[float], None] = lambda share: None) -> Tables:
    """The tables of a log's first parts.

    Raises:
        LogError: as `read_tables`.
    """
    parts: list[Tables] = []

    def take(tables: Tables) -> None:
        parts.append(tables)
        if len(parts) == _PARTS:
            raise _Enough

    try:
        parts.append(read_tables(path, Ask(tell=tell, part=take)))
        return reduce(joined, parts)
    except _Enough:
        return with_notes(
            reduce(joined, parts), [f"{path.name}: the file is long, so only its beginning was examined."]
        )


class _Enough(BaseException):
    """Ends the reading of a file. Not an Exception, as readers catch those as damage."""
