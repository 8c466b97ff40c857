"""What a recipe says about itself, read from its file without running it: `info` and `methods` then need no JAX.

This works for a recipe whose name, title, source and false alarm rate are plain text, or text with constants of the
same file, and whose `needs` stands in a file that imports no JAX. Any other recipe is found by importing its file.
"""

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from sensorfault.methods.recipe import Recipe

_TEXT = "name", "title", "source", "false_alarm_rate"


class _NotPlain(Exception):
    """The file must be imported to know this."""


def recipes(module: str) -> tuple[Recipe, ...]:
    """The RECIPE, or the RECIPES, of a module; none for any other module."""
    source = _source(module)
    if "RECIPE" not in source:
        return ()
    try:
        return tuple(_File(module, ast.parse(source)).recipes())
    except _NotPlain:
        return _imported(module)


def _source(module: str) -> str:
    spec = find_spec(module)
    loader: Any = spec.loader if spec else None
    return loader.get_source(module) or "" if hasattr(loader, "get_source") else "RECIPE"


def _imported(module: str) -> tuple[Recipe, ...]:
    names = vars(import_module(module))
    return tuple(names.get("RECIPES", (names["RECIPE"],) if "RECIPE" in names else ()))


def _build(module: str, name: str, *given: Any) -> Any:
    return next(recipe for recipe in _imported(module) if recipe.name == name).build(*given)


def _needs(module: str, path: tuple[str, ...], *given: Any) -> Any:
    found: Any = import_module(module)
    for part in path:
        found = getattr(found, part)
    return found(*given)


@dataclass(frozen=True)
class _File:
    module: str
    tree: ast.Module

    def recipes(self) -> Iterator[Recipe]:
        """Each `Recipe(...)` that RECIPE or RECIPES is made of."""
        if "RECIPES" in self._assigned:
            yield from (self._recipe(one) for one in self._elements(self._assigned["RECIPES"]))
        elif "RECIPE" in self._assigned:
            yield self._recipe(self._assigned["RECIPE"])

    @cached_property
    def _assigned(self) -> dict[str, ast.expr]:
        lines = [line for line in self.tree.body if isinstance(line, ast.Assign)]
        return {target.id: line.value for line in lines for target in line.targets if isinstance(target, ast.Name)}

    @cached_property
    def _homes(self) -> dict[str, tuple[str, str]]:
        """Name -> the module it was imported from, and what it is called there."""
        lines = [line for line in self.tree.body if isinstance(line, ast.ImportFrom) and line.module and not line.level]
        return {alias.asname or alias.name: (line.module or "", alias.name) for line in lines for alias in line.names}

    def _recipe(self, node: ast.expr) -> Recipe:
        match node:
            case ast.Call(func=ast.Name("Recipe"), args=[]):
                given = {keyword.arg: keyword.value for keyword in node.keywords}
            case _:
                raise _NotPlain
        if not {*_TEXT, "build"} <= given.keys() <= {*_TEXT, "build", "needs", "parts"}:
            raise _NotPlain
        text = {name: self._text(given[name]) for name in _TEXT}
        return Recipe(
            **text,
            build=partial(_build, self.module, text["name"]),
            needs=self._later(given["needs"]) if "needs" in given else None,
            parts=tuple(self._part(one) for one in self._elements(given["parts"])) if "parts" in given else (),
        )

    def _text(self, node: ast.expr) -> str:
        match node:
            case ast.Name(id=name) if name in self._assigned:
                return self._text(self._assigned[name])
            case ast.Constant(value=str(text)):
                return text
        raise _NotPlain

    def _later(self, node: ast.expr) -> Callable[..., object]:
        """A function imported from another file, which is imported when it is called."""
        match node:
            case ast.Name(id=name) if name in self._homes:
                module, called = self._homes[name]
                return partial(_needs, module, (called,))
            case ast.Attribute(value=ast.Name(id=name), attr=method) if name in self._homes:
                module, called = self._homes[name]
                return partial(_needs, module, (called, method))
        raise _NotPlain

    def _elements(self, node: ast.expr) -> Iterator[ast.expr]:
        """The elements of a tuple, which may contain other tuples of the file."""
        match node:
            case ast.Name(id=name) if name in self._assigned:
                yield from self._elements(self._assigned[name])
            case ast.Tuple(elts=elements):
                for one in elements:
                    yield from self._elements(one.value) if isinstance(one, ast.Starred) else (one,)
            case _:
                raise _NotPlain

    def _part(self, node: ast.expr) -> Recipe:
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr="RECIPE") if name in self._homes:
                found = recipes(".".join(self._homes[name]))
                if len(found) == 1:
                    return found[0]
        raise _NotPlain
