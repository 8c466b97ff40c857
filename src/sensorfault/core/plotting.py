"""Who draws. A result offers `plot()`, but what draws it stands floors above it: the public face says who that is."""

from collections.abc import Callable
from typing import Any

_drawers: list[Callable[..., Any]] = []


def draw_with(drawer: Callable[..., Any]) -> None:
    """From now on `drawer` draws every result."""
    _drawers[:] = [drawer]


def draw(result: object, **options: Any) -> Any:
    """A figure of a result."""
    return _drawers[0](result, **options)
