"""The version of the code that a study's numbers are marked with."""

import re
from pathlib import Path

import pytest

from sensorfault.cli import commit as commits
from sensorfault.cli.commit import commit


def test_the_commit_is_the_checkouts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert commit(tmp_path) == commits._version()  # no checkout
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", commits._version())
    (tmp_path / ".git").mkdir()
    assert commit(tmp_path) == commits._version()  # a broken one
    monkeypatch.setenv("PATH", str(tmp_path))
    assert commit() == commits._version()  # git is absent


def test_the_commit_is_a_hash() -> None:
    home = Path(commits.__file__).parents[3]
    if not (home / ".git").exists():
        pytest.skip("needs a checkout")
    assert re.fullmatch(r"[0-9a-f]{40}(-dirty)?", commit())
