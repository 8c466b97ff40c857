"""The core installation and its extras: what each brings, and what is said where one is missing."""

import ast
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

import sensorfault as sf
from core import core_only
from sensorfault.cli.errors import sentence_of
from sensorfault.core.extras import EXTRA_OF, MissingLibrary, require, sentence_of_missing
from sensorfault.logs import LogError, VehicleFile, guess, read

HOME = Path(__file__).parents[2]
PROJECT = tomllib.loads((HOME / "pyproject.toml").read_text("utf-8"))["project"]
OWN = ("sensorfault", "sensorfault_studies")
TAKEN_WHERE_THERE = {"pandas"}  # a user's own table may be one; nothing needs it


def named(requirement: str) -> str:
    """A requirement's distribution: `python-can`."""
    return re.split(r"[\[<>=;~! ]", requirement)[0].lower()


CORE = {named(one) for one in PROJECT["dependencies"]}
EXTRAS = {
    extra: {named(one) for one in needed if named(one) != "sensorfault"}
    for extra, needed in PROJECT["optional-dependencies"].items()
}


def imports(path: Path) -> Iterator[tuple[str, bool]]:
    """Packages of others that a module imports, and whether it does so when it is imported itself."""

    def walk(node: ast.AST, at_import: bool) -> Iterator[tuple[str, bool]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                yield from ((alias.name, at_import) for alias in child.names)
            elif isinstance(child, ast.ImportFrom):
                yield child.module or "", at_import
            else:
                typing = isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test)
                yield from walk(child, at_import and not typing and not isinstance(child, ast.FunctionDef))

    for name, at_import in walk(ast.parse(path.read_text("utf-8")), True):
        package = name.partition(".")[0]
        if package not in sys.stdlib_module_names and package not in OWN:
            yield package, at_import


MODULES = {
    path.relative_to(HOME / "src").as_posix(): list(imports(path))
    for own in OWN
    for path in sorted((HOME / "src" / own).rglob("*.py"))
}
IMPORTED = {package for found in MODULES.values() for package, _ in found} - TAKEN_WHERE_THERE


@pytest.mark.parametrize("package", sorted(IMPORTED))
def test_every_library_is_a_dependency_or_in_its_extra(package: str) -> None:
    names = {name.lower() for name in packages_distributions()[package]}
    if names & CORE:
        assert package not in EXTRA_OF
    else:
        assert names & EXTRAS[EXTRA_OF[package]], f"{package} is in no extra of pyproject.toml"


def test_nothing_is_installed_that_nothing_imports() -> None:
    known = packages_distributions()
    used = {name.lower() for package in IMPORTED for name in known[package]}
    tools = {"all", "dev", "bench"}
    asked = CORE.union(*(needed for extra, needed in EXTRAS.items() if extra not in tools))
    assert asked - used == set()
    assert EXTRA_OF.keys() - IMPORTED == set()


def test_all_is_every_extra_of_users() -> None:
    (every,) = PROJECT["optional-dependencies"]["all"]
    listed = set(every.removeprefix("sensorfault[").removesuffix("]").split(","))
    assert listed == EXTRAS.keys() - {"all", "dev", "bench"}
    assert set(EXTRA_OF.values()) == listed


def test_only_what_reads_imports_polars_when_it_is_imported() -> None:
    allowed = ("sensorfault/logs/", "sensorfault_studies/")
    rest = [name for name, found in MODULES.items() if ("polars", True) in found and not name.startswith(allowed)]
    assert rest == []


def test_other_extras_are_imported_late() -> None:
    """A module that imports one at its top is itself imported only within functions."""
    lazy = {f"{name.removesuffix('.py').replace('/', '.')}" for name, found in MODULES.items() if any(
        at_import and package in EXTRA_OF and package != "polars" for package, at_import in found
    )}  # fmt: skip
    assert lazy  # of pyulog and pymavlink
    early = re.compile("^from (" + "|".join(map(re.escape, sorted(lazy))) + ") import", re.MULTILINE)
    assert [name for name in MODULES if early.search((HOME / "src" / name).read_text("utf-8"))] == []


def test_a_monitor_needs_the_core_installation_only(tmp_path: Path) -> None:
    path = tmp_path / "model.sensorfault"
    sf.save(sf.fit(core_only.healthy(0), "linear-conditioning"), path)
    program = [sys.executable, "-W", "error", core_only.__file__, path, *EXTRA_OF]
    environment = {**os.environ, "PYTHONPATH": str(HOME / "src"), "COLUMNS": "200"}
    done = subprocess.run(program, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    said = done.stdout
    assert "detect and Live: z" in said
    assert "read: x.csv: reading it needs polars; run `pip install 'sensorfault[tables]'`." in said
    assert re.search(r"^fit: 2 .*needs polars; run `pip install 'sensorfault\[tables\]'`\.$", said, re.MULTILINE)
    assert re.search(
        r"^report: 2 sensorfault: `sensorfault report` needs polars and plotly; "
        r"run `pip install 'sensorfault\[tables,plot\]'`\.$",
        said,
        re.MULTILINE,
    )
    assert sum(line.split(":")[1].startswith(" 2") for line in said.splitlines()) == len(core_only.VERBS)


def without(monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    """As if it were not installed."""
    monkeypatch.setitem(sys.modules, library, None)


def test_what_is_missing_is_named_with_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    require("a report page", "plotly")
    without(monkeypatch, "plotly")
    without(monkeypatch, "can")
    with pytest.raises(MissingLibrary) as caught:
        require("a page of a bus", "plotly", "polars", "can")
    expected = "a page of a bus needs plotly and can; run `pip install 'sensorfault[plot,bus]'`."
    assert str(caught.value) == expected
    assert sentence_of(caught.value, "whatever") == expected


def test_a_failed_import_of_another_kind_is_no_missing_extra() -> None:
    assert sentence_of_missing(ModuleNotFoundError("no", name="pyulog.core"), "this").startswith("this needs pyulog;")
    assert sentence_of_missing(ImportError("cannot import name", name="numpy"), "this") is None
    assert sentence_of(ImportError("cannot import name")) is None


def test_a_page_and_a_table_need_their_extras(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    log = core_only.healthy(0)
    without(monkeypatch, "polars")
    with pytest.raises(MissingLibrary, match=r"sensorfault\[tables\]"):
        log.frame()
    with pytest.raises(MissingLibrary, match=r"x\.csv: writing it needs polars"):
        sf.write(log, tmp_path / "x.csv")
    with pytest.raises(MissingLibrary, match=r"x\.csv: reading it needs polars"):
        guess(tmp_path / "x.csv")
    with pytest.raises(MissingLibrary, match=r"events\.parquet: writing it needs polars"):
        sf.write_events([], log, tmp_path / "events.parquet")
    sf.write_events([], log, tmp_path / "events.jsonl")
    assert [path.name for path in tmp_path.iterdir()] == ["events.jsonl"]


def test_a_folder_is_read_without_the_file_that_needs_an_extra(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "drive.csv").write_text("time,gyro_x\n" + "".join(f"{i / 10},{i % 7}\n" for i in range(50)))
    (tmp_path / "flight.ulg").write_bytes(b"ULog\x01\x12\x35" + bytes(50))
    without(monkeypatch, "pyulog")
    monkeypatch.delitem(sys.modules, "sensorfault.logs.readers.ulog_load", raising=False)
    with pytest.raises(
        LogError, match=r"flight\.ulg: reading it needs pyulog; run `pip install 'sensorfault\[logs\]'`"
    ):
        read(tmp_path / "flight.ulg")
    known: VehicleFile = guess(tmp_path)
    assert [sensor.file for sensor in known.sensors] == ["log"]
    assert any("flight.ulg: reading it needs pyulog" in note for note in known.notes)
