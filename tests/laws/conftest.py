from collections.abc import Iterator

import jax
import pytest

from haste import optimised
from laws.case import Case
from laws.cases import built
from laws.strict import strict

__all__ = ["strict"]


@pytest.fixture
def case(request: pytest.FixtureRequest, strict: None) -> Iterator[Case]:
    """The case of the name that a law is parametrised by; a law is strict about the monitor, not about its training.

    A training runs long enough to be worth optimising.
    """
    with jax.numpy_dtype_promotion("standard"), jax.numpy_rank_promotion("allow"), optimised(True):
        made = built(request.param)
    with optimised(False):
        yield made
