"""Numbers in words, for notes and errors."""

from collections.abc import Sequence


def counted(number: int, noun: str) -> str:
    """`1 row`, `2 rows`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def times(number: int) -> str:
    """`once`, `3 times`."""
    return "once" if number == 1 else f"{number} times"


def listed(names: Sequence[str], most: int = 8) -> str:
    """`a, b, c`; of more than `most` the first, and how many others."""
    if len(names) <= most:
        return ", ".join(names)
    return f"{', '.join(names[:most])} and {len(names) - most} others"


def sensors_named(names: Sequence[str]) -> str:
    """`sensors gyro, gnss`; of many the first."""
    return f"{'sensor' if len(names) == 1 else 'sensors'} {listed(names) or 'none'}"


def with_unit(name: str, unit: str) -> str:
    """`x [deg/s]`, or the name alone where there is no unit."""
    return f"{name} [{unit}]" if unit else name
