"""Libraries that print what they think of a file."""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from typing import Any

Aloud = Callable[[Callable[..., Any]], Callable[..., Any]]


@contextmanager
def quiet() -> Iterator[Aloud]:
    """What a library remarks, in Python and below, goes nowhere: what is wrong is told in one sentence.

    Yields what lets a function be heard that the library calls: progress, and who takes the parts of a file.
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
