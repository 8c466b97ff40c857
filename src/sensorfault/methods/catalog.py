"""Name -> recipe."""

from sensorfault.logs.table import LogError
from sensorfault.methods import elm_autoencoder, pca
from sensorfault.methods.recipe import Recipe

METHODS: dict[str, Recipe] = {recipe.name: recipe for recipe in (elm_autoencoder.RECIPE, pca.RECIPE)}
DEFAULT = elm_autoencoder.RECIPE.name


def recipe(name: str) -> Recipe:
    """The recipe of that name.

    Raises:
        LogError: there is none.
    """
    if name not in METHODS:
        raise LogError(f"no method is called '{name}'; take one of {', '.join(METHODS)}.")
    return METHODS[name]
