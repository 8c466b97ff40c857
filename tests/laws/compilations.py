"""Count what XLA compiles."""

from collections.abc import Iterator
from contextlib import contextmanager

import jax

_made: list[str] = []


def _listen(event: str, seconds: float, **_: object) -> None:
    if event == "/jax/core/compile/backend_compile_duration":
        _made.append(event)


jax.monitoring.register_event_duration_secs_listener(_listen)


@contextmanager
def compilations() -> Iterator[list[str]]:
    """The list, empty on entry, of the compilations made inside."""
    _made.clear()
    yield _made
