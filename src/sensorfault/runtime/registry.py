"""Every part that a model file may name. A part registers itself by being defined in one of the packages ROOMS.

Nothing else is ever built from a model file.
"""

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pkgutil import walk_packages

import equinox as eqx

ROOMS = ("sensorfault.core", "sensorfault.stages", "sensorfault.vehicles", "sensorfault.numerics")


@cache
def parts() -> dict[str, type[eqx.Module]]:
    """Part classes by name.

    Raises:
        TypeError: two parts have the same name, so that a model file would be ambiguous.
    """
    return parts_in(ROOMS)


def parts_in(rooms: Iterable[str]) -> dict[str, type[eqx.Module]]:
    """Part classes, by name, that the modules of these packages define.

    Raises:
        TypeError: two of them have one name.
    """
    found: dict[str, type[eqx.Module]] = {}
    for room in rooms:
        for module in walk_packages(import_module(room).__path__, f"{room}."):
            for name, thing in vars(import_module(module.name)).items():
                if isinstance(thing, type) and issubclass(thing, eqx.Module) and thing.__module__ == module.name:
                    if name in found:
                        raise TypeError(f"two parts are called {name}: {found[name].__module__} and {module.name}")
                    found[name] = thing
    return found
