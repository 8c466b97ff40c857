"""Papers' experiments again, ours beside their numbers.

A study registers itself: a module here, or the module `study` of a folder here, that has a STUDY. The entry point in
pyproject.toml names `studies`, which finds them all.
"""

from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sensorfault.cli.studies import Study


def studies() -> "Iterator[Study]":
    """Every study of this package, by name.

    Raises:
        ImportError: a study cannot be imported, or a folder has none.
    """
    for module in iter_modules(__path__, f"{__name__}."):
        name = f"{module.name}.study" if module.ispkg else module.name
        try:
            found = vars(import_module(name))
        except Exception as error:
            raise ImportError(f"{name} fails with {type(error).__name__}: {error}") from error
        if module.ispkg and "STUDY" not in found:
            raise ImportError(f"{name} has no STUDY")
        if "STUDY" in found:
            yield found["STUDY"]
