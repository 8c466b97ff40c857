"""One kind of log file, and ways to make its reader of a simpler function."""

from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path

from sensorfault.logs.readers.gzipped import inner
from sensorfault.logs.readers.source import Ask, Source, Tables


def _itself(path: Path) -> Path:
    return path


@dataclass(frozen=True)
class Format:
    """One kind of log file.

    `names`: patterns for the names of its files, in lower case, as `*.csv`. `read`: the tables of a file, as far as it
    can be read. `looks`: whether a file that begins with these 4096 bytes is one; needed where several formats name
    their files alike. `leader`: where several files are one log, the file that stands for them. `parts`: whether it can
    hand on a long file part by part. `priority`: of formats that all recognise a beginning, or none of which does, the
    highest is taken; formats that look and share a pattern must differ in it.
    """

    title: str
    names: tuple[str, ...]
    read: Callable[[Path, Ask], Tables]
    looks: Callable[[bytes], bool] | None = None
    leader: Callable[[Path], Path] = _itself
    parts: bool = False
    priority: int = 0

    def may_be(self, path: Path) -> bool:
        """Whether a file has a name of this format."""
        return any(fnmatchcase(inner(path).name.lower(), name) for name in self.names)


def one_table(read: Callable[[Path], Source]) -> Callable[[Path, Ask], Tables]:
    """The reader of a format with one table a file."""
    return lambda path, ask: {"": read(path)}


def in_parts(read: Callable[[Path], Source], rest: Callable[[Path, Ask], Source]) -> Callable[[Path, Ask], Tables]:
    """The same for a format whose long files can be handed on part by part."""
    return lambda path, ask: {"": read(path) if ask.part is None else rest(path, ask)}


def remembering(read: Callable[[Path, Ask], Tables]) -> Callable[[Path, Ask], Tables]:
    """The same reader, which remembers the last file: first one looks at what it holds, then one takes it."""

    @lru_cache(maxsize=1)
    def remembered(path: Path, changed_ns: int, size: int, ask: Ask) -> Tables:
        return read(path, ask)

    def reader(path: Path, ask: Ask) -> Tables:
        if ask.part is not None:  # nothing to remember of what is handed on
            return read(path, ask)
        stat = path.stat()
        return remembered(path, stat.st_mtime_ns, stat.st_size, ask)

    return reader
