"""The recipes of one family of the catalog, as they stand there."""

from importlib import import_module
from pkgutil import iter_modules

from laws import cases
from sensorfault.methods.catalog import METHODS


def family(name: str) -> tuple[str, ...]:
    """Names of the recipes in `sensorfault.methods.NAME`, without those whose file has a case file of the same name."""
    room = import_module(f"sensorfault.methods.{name}")
    own = {module.name for module in iter_modules(cases.__path__)}
    files = [module for module in iter_modules(room.__path__) if module.name not in own]
    modules = [vars(import_module(f"{room.__name__}.{module.name}")) for module in files]
    standing = [recipe for names in modules for recipe in names.get("RECIPES", (names.get("RECIPE"),))]
    return tuple(name for name, recipe in METHODS.items() if any(one and recipe.name == one.name for one in standing))
