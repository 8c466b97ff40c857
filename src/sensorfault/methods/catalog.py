"""Name -> recipe. A recipe registers itself: any module in a family below that has a RECIPE, or RECIPES, is found."""

from collections.abc import Iterator
from difflib import get_close_matches
from importlib import import_module
from pkgutil import iter_modules

from sensorfault import methods
from sensorfault.logs.table import LogError
from sensorfault.methods import cards
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime import former
from sensorfault.runtime.names import CHANNELS, VEHICLES

FAMILIES = ("inertial", "position", "height", "ranging", "gnss", "arm", "composite")  # as the catalog lists them
DEFAULT = "relative-conditioning"


def _recipes() -> Iterator[Recipe]:
    families = [module.name for module in iter_modules(methods.__path__) if module.ispkg and module.name != "common"]
    for family in sorted(families, key=lambda name: (*FAMILIES, name).index(name)):
        package = import_module(f"{methods.__name__}.{family}")
        for module in iter_modules(package.__path__, f"{package.__name__}."):
            yield from cards.recipes(module.name)


def _by_name() -> dict[str, Recipe]:
    found: dict[str, Recipe] = {}
    for recipe in _recipes():
        if recipe.name in found:
            raise TypeError(f"two recipes are called {recipe.name}")
        found[recipe.name] = recipe
    return found


METHODS = _by_name()


def recipe(name: str) -> Recipe:
    """The recipe of that name, or of a former one.

    Raises:
        LogError: there is none.
    """
    found = METHODS.get(former.METHODS.get(name, name))
    if found is None:
        known = (*VEHICLES, *CHANNELS, *METHODS)
        near = [one for one in known if one.startswith(name)][:3] or get_close_matches(name, known, 3)
        like = f"did you mean {' or '.join(near)}?" if near else f"take one of {', '.join((*VEHICLES, *CHANNELS))}."
        raise LogError(f"no method is called '{name}'; {like} `sensorfault methods --all` lists all of them.")
    return found
