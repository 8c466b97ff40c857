"""The recipes of one family of the catalog, as they stand there."""

from importlib import import_module
from pkgutil import iter_modules

from sensorfault.methods.catalog import METHODS


def family(name: str) -> tuple[str, ...]:
    """Names of the recipes that stand in `sensorfault.methods.NAME`."""
    room = import_module(f"sensorfault.methods.{name}")
    modules = [vars(import_module(module.name)) for module in iter_modules(room.__path__, f"{room.__name__}.")]
    standing = [recipe for names in modules for recipe in names.get("RECIPES", (names.get("RECIPE"),))]
    return tuple(name for name, recipe in METHODS.items() if any(recipe is one for one in standing))
