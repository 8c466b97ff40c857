"""README, docs, citation and the README of each folder: what they name is there, in the words of this project."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from sensorfault.core import types

ROOT = Path(__file__).parents[1]
SRC = ROOT / "src"
PAGES = [*(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")), *sorted(ROOT.glob("docs/*.md"))]
FOLDERS = [
    *sorted(path.parent for path in (SRC / "sensorfault").rglob("__init__.py")),
    *(ROOT / name for name in ("src/sensorfault_studies", "tests", "benchmarks")),
]
TUPLES = ("Sample", "Residual", "Score", "Evidence", "Accusation", "Verdict", "Trust", "Report")
NOT_OURS = r"\b(told|heard|deaf|foretold|foretells|innocents)\b"  # words that readers stumble over
NAMED = re.compile(r"`([\w./]+\.(?:py|md|js|css|html))`")


def named_in(text: str) -> Iterator[str]:
    """Files that a text names between backquotes, or that it links to."""
    yield from NAMED.findall(text)
    yield from (link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", text) if "://" not in link)


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: str(folder.relative_to(ROOT)))
def test_each_folder_has_a_readme_that_names_what_is_there(folder: Path) -> None:
    text = (folder / "README.md").read_text(encoding="utf-8")
    assert 3 <= len(text.splitlines()) <= 25
    assert text.startswith("# ")
    for name in named_in(text):
        assert any((home / name).exists() for home in (folder, SRC / "sensorfault", ROOT)), name
    for name in re.findall(r"`(\w+(?:/\w+)*)/?`", text):
        if "/" in name:
            assert any((home / name).exists() for home in (folder, SRC / "sensorfault", ROOT)), name
    assert not re.search(NOT_OURS, text, re.IGNORECASE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_what_a_page_names_is_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    made = set(re.findall(r"^`([\w./]+)`:$", text, re.MULTILINE))  # by a walk of CONTRIBUTING
    for name in named_in(text):
        assert name in made or any((home / name).exists() for home in (page.parent, ROOT, SRC / "sensorfault")), name
    for name in re.findall(r"`((?:src|tests|docs|benchmarks)/[\w/]*)`", text):
        assert (ROOT / name).is_dir(), name
    assert not re.search(NOT_OURS, text, re.IGNORECASE)


def test_the_readme_is_short_and_leads_on() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 130
    assert {"CONTRIBUTING.md", "docs/architecture.md", "docs/glossary.md", "LICENSE"} <= set(named_in(text))


@pytest.mark.parametrize("name", TUPLES)
def test_the_glossary_has_each_field(name: str) -> None:
    glossary = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    entries = re.findall(r"^- (.+?):(?= )", glossary, re.MULTILINE)
    heads = [head for head in entries if re.search(rf"\([^)]*\b{name}\b[^)]*\)$", head)]
    explained = {field for head in heads for field in re.findall(r"\*\*`(\w+)`\*\*", head)}
    missing = set(getattr(types, name)._fields) - explained
    assert not missing, f"explain {', '.join(sorted(missing))} of {name} in docs/glossary.md"


def test_the_citation_is_of_this_version_and_of_five_papers() -> None:
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert f"\nversion: {project['version']}\n" in text
    assert text.count("\n  - type: article\n") == 5
    for folder in (SRC / "sensorfault_studies").glob("*/study.py"):
        assert f"`sensorfault reproduce {folder.parent.name}`" in text


def test_the_licence_is_apache_2() -> None:
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert "Apache License\n" in text
    assert "Copyright 2026 The Sensorfault authors" in text
    assert "Copyright 2026 The Sensorfault authors" in (ROOT / "NOTICE").read_text(encoding="utf-8")
