"""Which studies `sensorfault reproduce` finds, and its sentence where they cannot be found."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from cli.conftest import Install, Run
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.study import Study

GUEST = """
from types import SimpleNamespace
print("imported")

class Coin:
    name, title, paper = "coin", "Heads or tails", "Nobody 2001"
    def reproduce(self, seeds, quick, tell):
        tell("throwing", 0.5)
        columns, rows = ("side", "share"), [("heads", "0.5")]
        table = SimpleNamespace(heading="Throws", columns=columns, rows=rows, numbers=("share",))
        return SimpleNamespace(
            remarks=("It stood on its edge.",), records=lambda: [{"value": seeds}], tables=lambda: [table],
            page=lambda facts: f"<p>{facts}</p>",
        )

coin = Coin()
"""


def plain(name: str) -> Study:
    def run(effort: Effort) -> Findings:
        raise AssertionError("it went to work")

    return Study(name, "", "", run, {})


def test_the_studies_of_this_repository(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """If this fails, the installed entry points are older than pyproject.toml: install the package again."""
    said = run("reproduce", "--json", "-")
    names = [one["name"] for one in json.loads(said.out)["studies"]]
    assert names == ["min2021", "multistep", "niu1998", "wang2023", "xu2023"]
    assert "Min et al. 2021" in run("reproduce").out
    monkeypatch.setenv("SENSORFAULT_DATA", str(tmp_path / "empty"))
    for name in names:
        said = run("reproduce", name)
        assert (said.code, said.out) == (2, "")
        assert "set SENSORFAULT_DATA" in said.err


def test_a_study_of_another_package(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It shares no class with ours and brings all that the command line shows."""
    home = tmp_path / "site"
    (home / "guest-1.0.dist-info").mkdir(parents=True)
    (home / "guest-1.0.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: guest\nVersion: 1.0\n")
    (home / "guest-1.0.dist-info" / "entry_points.txt").write_text("[sensorfault.studies]\ncoins = guest_coin:coin\n")
    (home / "guest_coin.py").write_text(GUEST)
    monkeypatch.syspath_prepend(home)
    said = run("reproduce", "coin", "--seeds", "3", "--out", "there", "--json", "rows.json")
    assert said.code == 0
    assert "Throws" in said.out
    assert "heads" in said.out
    assert "It stood on its edge." in said.err
    assert Path("there/coin.html").read_text().endswith("3 seeds</p>")
    assert json.loads(Path("rows.json").read_text())["rows"] == [{"value": 3}]
    assert {"coin", "min2021"} <= set(run("reproduce", "nosuch").err.replace(",", "").split())


@pytest.mark.parametrize(
    "given", [plain("one"), (plain("one"),), lambda: iter([plain("one")]), lambda: plain("one")], ids=lambda one: ""
)
def test_an_entry_point_gives_one_or_several(run: Run, install: Install, given: object) -> None:
    install(given, [plain("two")])
    assert run("reproduce", "nosuch").err == (
        "sensorfault: no study is called 'nosuch'; take one of one, two, or all.\n"
    )


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ([], "no study is installed (no entry point sensorfault.studies); run `pip install sensorfault` again."),
        (
            [ImportError("No module named 'torch'")],
            "cannot be loaded (No module named 'torch'); repair or uninstall its package.",
        ),
        (
            [SyntaxError("bad line")],
            "cannot be loaded (SyntaxError: bad line); repair or uninstall its package.",
        ),
        ([3], "cannot be loaded (TypeError: 'int' object is not iterable); repair or uninstall its package."),
        ([[plain("one"), "two"]], "gives a str, which is no study; repair its package."),
        ([plain("one"), [plain("one")]], "two studies are called one, by the entry point tests"),
    ],
)
def test_what_cannot_be_found_is_one_sentence(run: Run, install: Install, given: list[object], sentence: str) -> None:
    install(*given)
    for words in (["one"], ["all"], []):
        said = run("reproduce", *words)
        assert (said.code, said.out) == (2, "")
        (line,) = said.err.splitlines()
        assert line.startswith("sensorfault: ")
        assert sentence in line


def test_the_package_works_without_its_studies(tmp_path: Path) -> None:
    """Nothing but `reproduce` looks for them."""
    code = (
        "import sys\n"
        "sys.modules['sensorfault_studies'] = None\n"
        "import sensorfault.cli, sensorfault.cli.reproduce, sensorfault.cli.studies\n"
        "import sensorfault as sf\n"
        "assert all(getattr(sf, name) is not None for name in sf.__all__)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)
