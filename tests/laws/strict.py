"""The strictest JAX there is, compiled in haste, for every test of a folder whose conftest imports this fixture."""

from collections.abc import Iterator
from contextlib import contextmanager

import jax
import pytest


@pytest.fixture(autouse=True)
def strict() -> Iterator[None]:
    with jax.numpy_rank_promotion("raise"), jax.numpy_dtype_promotion("strict"), optimised(False):
        yield


@contextmanager
def optimised(on: bool) -> Iterator[None]:
    """Whether LLVM optimises what is compiled inside.

    A few hundred samples are run in less time than that takes. XLA's own passes, which regroup and fuse, run always;
    the tests of runners, methods and real logs run what users run.
    """
    jax.config.update("jax_disable_most_optimizations", not on)
    try:
        yield
    finally:
        jax.config.update("jax_disable_most_optimizations", False)
