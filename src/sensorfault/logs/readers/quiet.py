"""Silences libraries that print remarks on a file."""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from typing import Any

Aloud = Callable[[Callable[..., Any]], Callable[..., Any]]


@contextmanager
def quiet() -> Iterator[Aloud]:
    """Hide what a library prints, in Python and in C; the reader reports errors itself.

    Yields a wrapper for functions that the library calls and that may print: progress, and the taker of parts.
    """
    with ExitStack() as hushed:
        hushed.enter_context(_hushed())

        def aloud(call: Callable[..., Any]) -> Callable[..., Any]:
            def received(*said: Any) -> Any:
                hushed.close()
                try:
                    return call(*said)
                finally:
                    hushed.enter_context(_hushed())

            return received

        yield aloud


@contextmanager
def _hushed() -> Iterator[None]:
    kept = [os.dup(stream) for stream in (1, 2)]
    with open(os.devnull, "w") as nowhere, redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        try:
            for stream in (1, 2):
                os.dup2(nowhere.fileno(), stream)
            yield
        finally:
            for stream, own in zip((1, 2), kept, strict=True):
                os.dup2(own, stream)
                os.close(own)
