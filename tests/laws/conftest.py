from collections.abc import Iterator

import jax
import pytest

from haste import optimised
from laws.case import Case
from laws.cases import guests
from laws.register import built
from laws.strict import strict
from sensorfault.runtime import registry

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


@pytest.fixture
def guests_known(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """For a guest, as if the toy parts stood in a room of the package, so that its monitor can be saved."""
    if case.name in guests.CASES:
        known = registry.parts() | registry.parts_in(["laws.guests"])
        monkeypatch.setattr(registry, "parts", lambda: known)
