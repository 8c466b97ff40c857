"""Arguments of the public functions: a wrong type is answered with one sentence that says what to give."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

LOG = "a Log, as sf.read returns it"
MODEL = "a Model, as sf.fit or sf.load returns it"
DETECTION = "a Detection, as sf.detect returns it"
FAULTS = "a list of sf.Fault"
EVENTS = "a list of sf.Event, as `events` of a Detection"

Item = TypeVar("Item")


def expect(value: object, kind: type | tuple[type, ...], where: str, give: str) -> None:
    """Refuse a value of another type.

    Args:
        value: what was given.
        kind: what it must be an instance of.
        where: `detect: log`, the function and its argument.
        give: what to give, as in "a Log, as sf.read returns it".

    Raises:
        TypeError: it is something else.
    """
    if isinstance(value, kind):
        return
    if isinstance(getattr(value, "log", value), kind):
        give = f"its .log, {give}"
    raise wrong(value, where, give)


def expect_all(values: object, kind: type[Item], where: str, give: str) -> list[Item]:
    """The items of a list; refuse what is none, or holds something of another type.

    Raises:
        TypeError: it is no list, or one of its items is something else.
    """
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise wrong(values, where, give)
    items = list(values)
    for value in items:
        if not isinstance(value, kind):
            raise TypeError(f"{where} holds {called(value)}; give {give}.")
    return items


def expect_path(value: object, where: str) -> None:
    """Refuse what is no path.

    Raises:
        TypeError: neither a str nor a Path.
    """
    expect(value, (str, Path), where, "the path of a file")


def wrong(value: object, where: str, give: str) -> TypeError:
    """The error for a value of a wrong type."""
    return TypeError(f"{where} is {called(value)}; give {give}.")


def called(value: Any) -> str:
    """`None`, `a str ('drive.csv')`, `a Detection`: what a sentence calls a value."""
    if value is None:
        return "None"
    name = type(value).__name__
    article = "an" if name[0] in "AEIOUaeiou" or name == "ndarray" else "a"
    if isinstance(value, str | int | float):
        text = repr(value)
        return f"{article} {name} ({text if len(text) <= 60 else text[:57] + '...'})"
    return f"{article} {name}"
