"""No part stands in the stages that neither a recipe nor a study is made of."""

import ast
from functools import cache
from pathlib import Path

import equinox as eqx
import pytest

import sensorfault
from sensorfault.runtime.registry import parts

SRC = Path(sensorfault.__file__).parents[1]
MAKERS = "sensorfault.methods.", "sensorfault_studies."  # recipes and studies: what they import is in use


@cache
def modules() -> dict[str, ast.Module]:
    files = [file for room in ("sensorfault", "sensorfault_studies") for file in sorted((SRC / room).rglob("*.py"))]
    names = [".".join(file.relative_to(SRC).with_suffix("").parts).removesuffix(".__init__") for file in files]
    return {name: ast.parse(file.read_text(encoding="utf-8")) for name, file in zip(names, files, strict=True)}


def imported(tree: ast.Module) -> set[str]:
    """The modules of the package that this one imports."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    return names & modules().keys()


@cache
def in_use() -> frozenset[str]:
    """Recipes, studies, and all that they import."""
    found: set[str] = set()
    todo = [name for name in modules() if name.startswith(MAKERS)]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            todo += imported(modules()[name])
    return frozenset(found)


def called(tree: ast.Module) -> set[str]:
    """Names of what this module calls: `Part(...)`, and `Part.fitted(...)`."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            makers = [node.func, *([node.func.value] if isinstance(node.func, ast.Attribute) else [])]
            names |= {maker.id for maker in makers if isinstance(maker, ast.Name)}
            names |= {maker.attr for maker in makers if isinstance(maker, ast.Attribute)}
    return names


def makers(part: type[eqx.Module]) -> list[str]:
    """Modules in use, other than its own, that make this part."""
    return [name for name in in_use() - {part.__module__} if part.__name__ in called(modules()[name])]


IN_STAGES = {name: part for name, part in parts().items() if part.__module__.startswith("sensorfault.stages.")}


@pytest.mark.parametrize("name", IN_STAGES)
def test_every_part_is_used(name: str) -> None:
    assert makers(IN_STAGES[name]), (
        f"{IN_STAGES[name].__module__}: no recipe and no study makes a {name}; use it in one, or delete it."
    )


def test_the_search_finds_what_is_made_and_nothing_else() -> None:
    made = ast.parse("from a import Part, Other, Third\nx: Other = Part(1)\ny = Third.fitted(x)")
    assert {"Part", "Third"} <= called(made)
    assert "Other" not in called(made)
    assert "sensorfault.methods.catalog" in in_use()
    assert len(IN_STAGES) > 50
