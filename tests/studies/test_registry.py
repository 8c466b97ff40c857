"""How a study registers itself: nothing is forgotten, and no study leans on another."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import sensorfault_studies
from sensorfault_studies import studies

HOME = Path(sensorfault_studies.__file__).parent
FOLDERS = sorted(path.name for path in HOME.iterdir() if path.is_dir() and path.name != "__pycache__")


def test_every_folder_is_a_study() -> None:
    found = {study.name: study for study in studies()}
    assert set(FOLDERS) <= set(found)
    for study in found.values():
        assert study.title, study.name
        assert study.paper, study.name
        assert study.experiments, study.name


@pytest.mark.parametrize("name", FOLDERS)
def test_a_study_imports_no_other(name: str) -> None:
    for path in (HOME / name).rglob("*.py"):
        imported = set(re.findall(r"(?:from|import) sensorfault_studies\.(\w+)", path.read_text()))
        others = imported & set(FOLDERS) - {name}
        assert not others, f"{path} imports the study {', '.join(others)}; move what both need up"


def test_what_studies_share_imports_none() -> None:
    for path in HOME.glob("*.py"):
        imported = set(re.findall(r"(?:from|import) sensorfault_studies\.(\w+)", path.read_text()))
        assert not imported & set(FOLDERS), path


@pytest.fixture
def guests(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    """A folder in which the package looks for studies, too."""
    monkeypatch.setattr(sensorfault_studies, "__path__", [*sensorfault_studies.__path__, str(tmp_path)])
    yield tmp_path
    for name in [name for name in sys.modules if name.startswith("sensorfault_studies.guest")]:
        del sys.modules[name]


STUDY = "from sensorfault_studies.study import Study\nSTUDY = Study({!r}, 'Title', 'Paper', print, {{'X': 'Y'}})\n"


def test_a_new_study_is_one_file_or_folder(guests: Path) -> None:
    (guests / "guest_file.py").write_text(STUDY.format("in-a-file"))
    (guests / "guest_folder").mkdir()
    (guests / "guest_folder" / "__init__.py").touch()
    (guests / "guest_folder" / "study.py").write_text(STUDY.format("in-a-folder"))
    assert {"in-a-file", "in-a-folder", *FOLDERS} == {study.name for study in studies()}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "guest_lost.study fails with ModuleNotFoundError"),
        (
            "import no_such_library",
            "fails with ModuleNotFoundError: No module named 'no_such_library'",
        ),
        ("1 / 0", "guest_lost.study fails with ZeroDivisionError: division by zero"),
        ("study = 1", "guest_lost.study has no STUDY"),
    ],
)
def test_a_study_that_is_lost_is_named(guests: Path, text: str | None, sentence: str) -> None:
    (guests / "guest_lost").mkdir()
    (guests / "guest_lost" / "__init__.py").touch()
    if text is not None:
        (guests / "guest_lost" / "study.py").write_text(text)
    with pytest.raises(ImportError, match=re.escape(sentence)):
        list(studies())
