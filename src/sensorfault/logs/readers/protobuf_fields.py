"""The numbers in a protocol buffer of any type: their paths, and a quick way to take them out."""

from collections.abc import Callable, MutableSequence, Sequence
from math import nan
from operator import attrgetter
from typing import Any

from sensorfault.logs.readers.fields import LONGEST

Take = Callable[[Any, MutableSequence[float]], None]  # appends numbers of a message


class ProtobufFields:
    """As `Fields`, for protocol buffers: the description gives the numbers, the first message the lengths of lists.

    Numbers of a missing message are NaN. The messages of a list are named `joints[0].position`.
    """

    def __init__(self, first: Any) -> None:
        self.names: list[str] = []
        self.left_out: list[str] = []
        self.take = self._message(first, "", ())

    def _message(self, first: Any, path: str, above: tuple[str, ...]) -> Take:
        """What takes a message; `above`: the types that hold it, of which it holds none."""
        kind = first.DESCRIPTOR
        above = (*above, kind.full_name)
        plain = [field.name for field in kind.fields if _is_number(field) and not field.has_presence]
        self.names += [path + name for name in plain]
        takes = [_plain(plain)] if plain else []
        takes += [
            self._list(field.name, getattr(first, field.name), path + field.name, above)
            if field.is_repeated
            else self._one(field, first, path + field.name, above)
            for field in kind.fields
            if field.name not in plain and not _is_other(field, above)
        ]
        return _all(takes)

    def _one(self, field: Any, first: Any, path: str, above: tuple[str, ...]) -> Take:
        """An optional number, or a message."""
        before = len(self.names)
        if field.message_type is None:
            self.names.append(path)
            return _if_there(field.name, lambda number, rows: rows.append(number), 1)
        take = self._message(getattr(first, field.name), f"{path}.", above)
        return _if_there(field.name, take, len(self.names) - before)

    def _list(self, name: str, first: Sequence[Any], path: str, above: tuple[str, ...]) -> Take:
        if len(first) > LONGEST:
            self.left_out.append(f"{path} ({len(first)} in a list)")
            return _all([])
        parts = []
        for i, one in enumerate(first):
            before = len(self.names)
            if hasattr(one, "DESCRIPTOR"):
                take = self._message(one, f"{path}[{i}].", above)
            else:
                self.names.append(f"{path}[{i}]")
                take = lambda number, rows: rows.append(number)  # noqa: E731
            parts.append((take, len(self.names) - before))
        return _several(name, parts)


def _is_number(field: Any) -> bool:
    return not (
        field.is_repeated or field.message_type is not None or field.type in (field.TYPE_STRING, field.TYPE_BYTES)
    )


def _is_other(field: Any, above: tuple[str, ...]) -> bool:
    """Text, bytes, a map, or a type that holds itself."""
    inner = field.message_type
    if inner is None:
        return field.type in (field.TYPE_STRING, field.TYPE_BYTES)
    return inner.full_name in above or inner.GetOptions().map_entry


def _plain(names: list[str]) -> Take:
    get: Callable[[Any], Any] = attrgetter(*names)
    if len(names) == 1:
        return lambda message, rows: rows.append(get(message))
    return lambda message, rows: rows.extend(get(message))


def _all(takes: list[Take]) -> Take:
    if len(takes) == 1:
        return takes[0]

    def take_all(message: Any, rows: MutableSequence[float]) -> None:
        for take in takes:
            take(message, rows)

    return take_all


def _if_there(name: str, take: Take, count: int) -> Take:
    lacking = [nan] * count

    def take_if_there(message: Any, rows: MutableSequence[float]) -> None:
        if message.HasField(name):
            take(getattr(message, name), rows)
        else:
            rows.extend(lacking)

    return take_if_there


def _several(name: str, parts: list[tuple[Take, int]]) -> Take:
    def take_several(message: Any, rows: MutableSequence[float]) -> None:
        found = getattr(message, name)
        for i, (take, count) in enumerate(parts):
            if i < len(found):
                take(found[i], rows)
            else:
                rows.extend([nan] * count)

    return take_several
