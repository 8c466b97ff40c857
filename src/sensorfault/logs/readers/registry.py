"""Every format. A reader's module registers its own: any module in this package that has a FORMAT, or FORMATS.

Modules named `*_load` are not looked at: readers import them when they read, for the libraries that they need.
"""

import re
from fnmatch import translate
from functools import cache
from importlib import import_module
from pkgutil import walk_packages

from sensorfault.logs import readers
from sensorfault.logs.readers.format import Format


@cache
def registered() -> tuple[Format, ...]:
    """Every format, the highest priority first, then by title.

    Raises:
        TypeError: two formats have one title.
    """
    found: dict[str, Format] = {}
    for module in walk_packages(readers.__path__, f"{readers.__name__}."):
        if module.name.endswith("_load"):
            continue
        names = vars(import_module(module.name))
        for form in names.get("FORMATS", (names["FORMAT"],) if "FORMAT" in names else ()):
            if form.title in found:
                raise TypeError(f"two formats are called {form.title}")
            found[form.title] = form
    return tuple(sorted(found.values(), key=lambda form: (-form.priority, form.title.casefold())))


@cache
def pattern() -> re.Pattern[str]:
    """What the names of logs look like, in lower case; packed ones, too."""
    names = "|".join(translate(name).removesuffix(r"\Z") for form in registered() for name in form.names)
    return re.compile(rf"(?:{names})(?:\.gz)?|.*\.zip")


def suffixes() -> tuple[str, ...]:
    """How the names of files that can be read end: `.csv`."""
    names = {name.removeprefix("*") for form in registered() for name in form.names}
    return tuple(sorted(names, key=lambda name: ("[" in name, name)))
