"""What the catalog reads of a recipe without running its file is what its file says."""

import sys
from pathlib import Path

import pytest

from sensorfault.methods import cards
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.recipe import Recipe

PLAIN = """
from sensorfault.methods.inertial.needs import in_a_row
from sensorfault.methods.recipe import Recipe

NAME = "plain"
RECIPE = Recipe(
    name=NAME,
    title="Two "
    "lines",
    source="nobody",
    false_alarm_rate="none",
    build=lambda log, seed, session: (log, seed, session),
    needs=in_a_row,
)
"""


def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str) -> str:
    (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    return name


@pytest.mark.parametrize("recipe", METHODS.values(), ids=METHODS)
def test_a_card_says_what_the_file_says(recipe: Recipe) -> None:
    build = recipe.build
    module = build.args[0]  # type: ignore[attr-defined]  # else the file had to be imported: see cards.py
    (same,) = (one for one in cards._imported(module) if one.name == recipe.name)
    assert (same.title, same.source, same.false_alarm_rate) == (recipe.title, recipe.source, recipe.false_alarm_rate)
    assert [part.name for part in same.parts] == [part.name for part in recipe.parts]
    assert (same.needs is None) == (recipe.needs is None)
    if recipe.needs is not None:
        home, path = recipe.needs.args  # type: ignore[attr-defined]
        assert (home, path[-1]) == (same.needs.__module__, same.needs.__name__)  # type: ignore[union-attr]


def test_a_plain_recipe_is_read_without_running_its_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = written(tmp_path, monkeypatch, "plain_recipe", PLAIN)
    (recipe,) = cards.recipes(module)
    assert module not in sys.modules
    assert (recipe.name, recipe.title) == ("plain", "Two lines")
    assert recipe.build("log", 3, "session") == ("log", 3, "session")  # type: ignore[arg-type, comparison-overlap]
    assert module in sys.modules


@pytest.mark.parametrize(
    ("plain", "other"),
    [
        ("NAME = ", "NAME = '' + "),
        ("source=", "source=str() + "),
        ("needs=in_a_row", "needs=lambda name, log: None"),
        ("RECIPE = Recipe(", "make = Recipe\nRECIPE = make("),
    ],
)
def test_any_other_recipe_is_found_by_importing_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, plain: str, other: str
) -> None:
    assert plain in PLAIN
    module = written(tmp_path, monkeypatch, f"other_recipe_{len(other)}", PLAIN.replace(plain, other))
    (recipe,) = cards.recipes(module)
    assert module in sys.modules
    assert recipe is sys.modules[module].RECIPE
    assert recipe.name == "plain"


def test_a_file_without_a_recipe_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cards.recipes(written(tmp_path, monkeypatch, "no_recipe", "raise ValueError")) == ()
    assert cards.recipes("sensorfault.methods.recipe") == ()
