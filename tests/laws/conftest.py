import jax
import pytest

from laws.case import Case
from laws.cases import built
from laws.strict import strict

__all__ = ["strict"]


@pytest.fixture
def case(request: pytest.FixtureRequest) -> Case:
    """The case of the name that a law is parametrised by; a law is strict about the monitor, not about its training."""
    with jax.numpy_dtype_promotion("standard"), jax.numpy_rank_promotion("allow"):
        return built(request.param)
