"""Every part that stands in a room can be saved, none twice, and what former names mean is still there."""

import ast
import sys
from collections import Counter
from pathlib import Path

import equinox as eqx
import pytest

import sensorfault
from sensorfault.methods.catalog import METHODS, recipe
from sensorfault.runtime import former
from sensorfault.runtime.registry import ROOMS, parts, parts_in

SRC = Path(sensorfault.__file__).parent


def is_module(base: ast.expr) -> bool:
    return ast.unparse(base).split("[")[0] in ("eqx.Module", "equinox.Module", "Module")


def written() -> list[tuple[str, str]]:
    """Module and name of every class below a room that the source says is an eqx.Module."""
    found = []
    for room in ROOMS:
        for file in sorted((SRC / room.removeprefix("sensorfault.")).rglob("*.py")):
            module = ".".join(("sensorfault", *file.relative_to(SRC).with_suffix("").parts))
            classes = [node for node in ast.parse(file.read_text()).body if isinstance(node, ast.ClassDef)]
            found += [(module, one.name) for one in classes if any(map(is_module, one.bases))]
    return found


def test_every_part_in_a_room_is_found() -> None:
    assert {(part.__module__, name) for name, part in parts().items()} == set(written())
    assert sum(module.startswith("sensorfault.stages.") for module, _ in written()) > 50


def test_names_are_unique() -> None:
    assert [name for name, times in Counter(name for _, name in written()).items() if times > 1] == []
    assert all(issubclass(part, eqx.Module) and part.__name__ == name for name, part in parts().items())


def test_two_parts_of_one_name_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    room = tmp_path / "room_of_twins"
    room.mkdir()
    for name in ("__init__", "one", "two"):
        text = "" if name == "__init__" else "import equinox as eqx\n\n\nclass Twin(eqx.Module):\n    pass\n"
        (room / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match=r"two parts are called Twin: room_of_twins\.one and room_of_twins\.two"):
        parts_in(("room_of_twins",))
    for name in [name for name in sys.modules if name.startswith("room_of_twins")]:
        del sys.modules[name]


def test_former_names_mean_what_is_there() -> None:
    assert set(former.PARTS.values()) <= parts().keys()
    assert not former.PARTS.keys() & parts().keys()
    assert set(former.METHODS.values()) <= METHODS.keys()
    assert not former.METHODS.keys() & METHODS.keys()
    for old, new in former.METHODS.items():
        assert recipe(old) is METHODS[new]
