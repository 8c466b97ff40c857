"""The numbers in a message of any type: their paths, and a quick way to take them out."""

from collections.abc import Callable, Iterator, Mapping, MutableSequence, Sequence
from math import nan
from operator import attrgetter
from typing import Any

import numpy as np

LONGEST = 32  # a longer array is a scan or a picture, no measurement
Getter = Callable[[Any], Any]


class Fields:
    """The numbers of one type of message, found in its first.

    `names`: `angular_velocity.x`, `position[0]`. `left_out`: paths of arrays that are too long, and of lists of others.
    """

    def __init__(self, first: Any) -> None:
        self.left_out: list[str] = []
        found = list(self._walk(first, ""))
        single = [path for path, count in found if count is None]
        several = [(path, count) for path, count in found if count is not None]
        self.names = [*single, *(f"{path}[{i}]" for path, count in several for i in range(count))]
        self._single = len(single)
        self._counts = [count for _, count in several]
        self._get = _getter([*single, *(path for path, _ in several)], first) if found else None

    def take(self, message: Any, rows: MutableSequence[float]) -> None:
        """Append one number for each name, NaN where this message has none; nothing if it fails."""
        if self._get is None:
            return
        start, found = len(rows), self._get(message)
        try:
            rows.extend(found[: self._single])
            for part, count in zip(found[self._single :], self._counts, strict=True):
                rows.extend(part.tolist())
                if len(part) != count:
                    raise TypeError
        except (TypeError, AttributeError, OverflowError):  # not as in the first message: one by one
            del rows[start:]
            rows.extend(self._one_by_one(found))

    def _one_by_one(self, found: Sequence[Any]) -> list[float]:
        row = [_number(one) for one in found[: self._single]]
        for part, count in zip(found[self._single :], self._counts, strict=True):
            known = [_number(one) for one in part[:count]] if isinstance(part, list | tuple | np.ndarray) else []
            row += known + [nan] * (count - len(known))
        return row

    def _walk(self, part: Any, path: str) -> Iterator[tuple[str, int | None]]:
        """Paths of numbers, and of arrays with their lengths."""
        if isinstance(part, bool | int | float | np.number | np.bool_):
            yield path, None
        elif isinstance(part, np.ndarray) or (isinstance(part, list | tuple) and part and _is_plain(part)):
            if 0 < len(part) <= LONGEST:
                yield path, len(part)
            elif len(part):
                self.left_out.append(f"{path} ({len(part)} numbers)")
        elif isinstance(part, list | tuple):
            if part:
                self.left_out.append(f"{path} (a list)")
        else:
            for name, inner in _members(part):
                yield from self._walk(inner, f"{path}.{name}" if path else name)


def _members(part: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(part, Mapping):
        yield from ((str(name), inner) for name, inner in part.items())
    else:
        names = getattr(part, "__dataclass_fields__", ())
        yield from ((name, getattr(part, name)) for name in names if name != "__msgtype__")


def _is_plain(part: Any) -> bool:
    return all(isinstance(one, bool | int | float) for one in part)


def _number(value: Any) -> float:
    return float(value) if isinstance(value, bool | int | float | np.number | np.bool_) else nan


def _getter(paths: list[str], first: Any) -> Getter:
    """All of the paths of a message as a tuple."""
    if isinstance(first, Mapping):
        keys = [path.split(".") for path in paths]
        return lambda message: tuple(_descend(message, one) for one in keys)
    get = attrgetter(*paths)
    return get if len(paths) > 1 else lambda message: (get(message),)


def _descend(message: Any, keys: list[str]) -> Any:
    for key in keys:
        if not isinstance(message, Mapping):
            return None
        message = message.get(key)
    return message
