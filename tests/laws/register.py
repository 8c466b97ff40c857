"""All that must obey the laws: what the modules of `cases` say. Nothing is listed here."""

import functools
from collections.abc import Callable
from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

import jax

from laws import cases
from laws.case import Case

OPTIONAL = ("permuted", "block", "rate", "moving")  # what only some cases have; there is a law for those that do


def modules() -> list[ModuleType]:
    return [import_module(module.name) for module in iter_modules(cases.__path__, f"{cases.__name__}.")]


def collected() -> dict[str, Callable[[], Case]]:
    found: dict[str, Callable[[], Case]] = {}
    for module in modules():
        for name, make in module.CASES.items():
            if name in found:
                raise TypeError(f"{module.__name__}: there is a case of {name} already; rename one, or delete it.")
            found[name] = make
    return found


CASES = collected()


def names_with(field: str) -> tuple[str, ...]:
    """The cases that have this field, as their modules say."""
    return tuple(name for module in modules() for name in getattr(module, "HAVE", {}).get(field, ()))


@functools.lru_cache(maxsize=1)
def built(name: str) -> Case:
    """The case of that name, made when a law first asks for it; the programs of the case before go.

    The laws of one case follow each other: see tests/conftest.py.
    """
    jax.clear_caches()
    case = CASES[name]()
    for field in OPTIONAL:
        if bool(getattr(case, field)) != (name in names_with(field)):
            raise TypeError(f"{name}: HAVE of its module must say whether it has '{field}', for there is a law of it.")
    return case
