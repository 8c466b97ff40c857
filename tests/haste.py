"""Less optimised code for tests whose logs are short: it is compiled in a third of the time."""

from collections.abc import Iterator
from contextlib import contextmanager

import jax


@contextmanager
def optimised(on: bool) -> Iterator[None]:
    """Whether LLVM optimises what is compiled inside.

    A few hundred samples are run in less time than that takes. XLA's own passes, which regroup and fuse, run always;
    the tests of runners and of real logs run what users run.
    """
    jax.config.update("jax_disable_most_optimizations", not on)
    try:
        yield
    finally:
        jax.config.update("jax_disable_most_optimizations", False)
