"""A small sound file of each format. A module registers its own here: its SMALL, from title to what writes the file.

A title is that of the format; what stands behind a comma tells files of one format apart.
"""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules


def _registered() -> dict[str, Callable[[Path], Path]]:
    found: dict[str, Callable[[Path], Path]] = {}
    for module in iter_modules(__path__, f"{__name__}."):
        own = import_module(module.name).SMALL
        assert not own.keys() & found.keys(), f"{module.name}: the title stands in another module, too"
        found |= own
    return found


SMALL = _registered()
