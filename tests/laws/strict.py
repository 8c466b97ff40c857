"""The strictest JAX there is, compiled in haste, for every test of a folder whose conftest imports this fixture."""

from collections.abc import Iterator

import jax
import pytest

import sensorfault.core._jax  # noqa: F401 - float64, whatever a test imports
from haste import optimised


@pytest.fixture(autouse=True)
def strict() -> Iterator[None]:
    with jax.numpy_rank_promotion("raise"), jax.numpy_dtype_promotion("strict"), optimised(False):
        yield
