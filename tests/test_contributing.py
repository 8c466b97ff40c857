"""CONTRIBUTING, followed literally: each walk's files are put where it says, into a copy, and its commands are run."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
FILE = re.compile(r"^`([\w./]+)`:\n\n```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMANDS = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
REPORTS = "passed-*.xml"
WALKS = dict(re.findall(r"^## Add a (\w+)\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL))


@dataclass(frozen=True)
class Walk:
    """One walk in a copy of the tree: what its commands printed, and the tests that they ran and passed."""

    printed: str
    passed: frozenset[str]


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package, the studies and the tests, as if it were installed."""
    root = tmp_path_factory.mktemp("tree")
    for folder in ("src", "tests"):
        shutil.copytree(ROOT / folder, root / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", root)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    metadata = root / "src" / f"{project['name']}-{project['version']}.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text(f"Name: {project['name']}\nVersion: {project['version']}\n")
    points = [
        f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in entries.items())
        for group, entries in project["entry-points"].items()
    ]
    (metadata / "entry_points.txt").write_text("\n".join(points))
    return root


@pytest.fixture
def walk(request: pytest.FixtureRequest, tree: Path) -> Iterator[Walk]:
    """The walk of that name; its files are gone afterwards, so that no walk leans on another."""
    text = WALKS[request.param]
    files = dict(FILE.findall(text))
    for path in files:
        assert not (tree / path).exists(), f"{path} is there already; a walk adds files and edits none."
    try:
        for path, content in files.items():
            (tree / path).parent.mkdir(exist_ok=True)  # one new folder at most
            (tree / path).write_text(content, encoding="utf-8")
        _lint(tree, files)
        printed = "".join(_run(tree, line) for block in COMMANDS.findall(text) for line in block.splitlines())
        cases = [case for report in tree.glob(REPORTS) for case in ElementTree.parse(report).iter("testcase")]
        yield Walk(printed, frozenset(case.attrib["name"] for case in cases if not len(case)))
    finally:
        for path in (*map(tree.joinpath, files), *tree.glob(REPORTS)):
            path.unlink(missing_ok=True)


def _lint(tree: Path, files: dict[str, str]) -> None:
    """What `make check` says of the files' looks."""
    for verb in (("check",), ("format", "--diff")):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *verb, "--no-cache", *files], cwd=tree, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout


def _run(tree: Path, line: str) -> str:
    """One command in the copy, with the copy's package; what it printed."""
    report = f"--junitxml=passed-{len(list(tree.glob(REPORTS)))}.xml"
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(tree / "src"),
        "PYTEST_ADDOPTS": f"-p no:cacheprovider {report}" if "pytest" in line else "",
        "COLUMNS": "200",
    }
    done = subprocess.run(
        ["bash", "-c", line], cwd=tree, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    assert done.returncode == 0, f"{line}\n{done.stdout[-6000:]}\n{done.stderr[-3000:]}"
    assert "Traceback" not in done.stderr
    return done.stdout


def on(name: str) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("walk", [name], indirect=True)


def said(printed: str, *words: str) -> bool:
    """Whether one line of the output has all of these."""
    return any(all(word in line for word in words) for line in printed.splitlines())


def test_there_are_four_walks() -> None:
    assert list(WALKS) == ["method", "reader", "vehicle", "study"]


def laws_of(walk: Walk, case: str) -> set[str]:
    return {name.partition("[")[0] for name in walk.passed if name.endswith(f"[{case}]")}


@on("method")
def test_a_method(walk: Walk) -> None:
    laws = laws_of(walk, "smoothed-deviation")
    assert "test_healthy_is_ok_and_a_lie_is_named" in laws
    assert "test_stream_equals_replay" in laws
    assert "test_saved_and_loaded_it_says_the_same" in laws
    assert "test_scores_are_those_of_a_loop" in walk.passed
    assert said(walk.printed, "smoothed-deviation", "Trigg 1964")
    assert said(walk.printed, "smoothed-deviation", "yes")
    assert said(walk.printed, "1:40", "gyro", "z", "spike")


@on("reader")
def test_a_reader(walk: Walk) -> None:
    assert "test_a_damaged_file_is_a_log_or_one_sentence[key-value lines]" in walk.passed
    assert "test_the_sound_file_is_a_log[key-value lines]" in walk.passed
    assert "test_every_format_is_fuzzed" in walk.passed
    assert "test_lines_are_rows_and_a_lacking_key_is_absent" in walk.passed
    assert said(walk.printed, "gyro", "x [rad/s], y [rad/s]", "50", "3000")
    assert said(walk.printed, "0:50.00", "gyro", "x", "spike")


@on("vehicle")
def test_a_vehicle(walk: Walk) -> None:
    laws = laws_of(walk, "cart-cubature")
    assert "test_healthy_is_ok_and_a_lie_is_named" in laws
    assert "test_saved_and_loaded_it_says_the_same" in laws
    assert "test_it_rolls_on_and_both_ranges_make_the_rail" in walk.passed
    assert said(walk.printed, "cart-cubature", "yes")
    assert said(walk.printed, "1:30", "near", "range")
    assert not said(walk.printed, "far ", "spike")


@on("study")
def test_a_study(walk: Walk) -> None:
    assert "test_the_largest_spikes_are_found_and_the_smallest_are_not" in walk.passed
    assert said(walk.printed, "Spikes of the gyro's z axis")
    assert said(walk.printed, "recall", "pca")
