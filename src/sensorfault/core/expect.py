"""Arguments of the public functions: a wrong type is answered with one sentence that says what to give."""

from typing import Any


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
    if not isinstance(value, kind):
        raise wrong(value, where, give)


def wrong(value: object, where: str, give: str) -> TypeError:
    """The error for a value of a wrong type."""
    return TypeError(f"{where} is {called(value)}; give {give}.")


def called(value: Any) -> str:
    """`None`, `a str ('drive.csv')`, `a Detection`: what a sentence calls a value."""
    if value is None:
        return "None"
    name = type(value).__name__
    article = "an" if name[0] in "AEIOUaeiou" else "a"
    if isinstance(value, str | int | float):
        text = repr(value)
        return f"{article} {name} ({text if len(text) <= 60 else text[:57] + '...'})"
    return f"{article} {name}"
