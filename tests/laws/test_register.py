"""Every recipe of the catalog is under the laws, once, and every case names somebody."""

from dataclasses import replace

import pytest

from laws.case import Case
from laws.cases import guests
from laws.guests import zoo
from laws.register import CASES, modules
from sensorfault.methods.catalog import METHODS


@pytest.mark.parametrize("name", METHODS)
def test_every_recipe_has_a_case(name: str) -> None:
    assert name in CASES, (
        f"{name} is in the catalog and under no law; give it a case: a module in tests/laws/cases with "
        f"CASES = {{'{name}': a function that makes its Case}}."
    )


def test_every_case_is_of_a_recipe_or_a_guest() -> None:
    assert CASES.keys() - METHODS.keys() == guests.CASES.keys()
    assert len(CASES) == sum(len(module.CASES) for module in modules())


def test_a_case_that_accuses_nobody_is_refused() -> None:
    case: Case = zoo.kalman()
    with pytest.raises(ValueError, match=r"^kalman: this case accuses nobody, .*\.$"):
        replace(case, named=())
    assert replace(case, named=(), moving=(0,)).moving == (0,)
