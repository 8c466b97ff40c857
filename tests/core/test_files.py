"""Files appear whole or not at all."""

import os
import stat
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sensorfault.core.files import appearing


def names(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir())


def test_the_file_is_there_after_the_block_and_not_before(tmp_path: Path) -> None:
    path = tmp_path / "answer.json"
    with appearing(path) as temporary:
        assert temporary.parent == path.parent  # so that the rename stays on one disk
        assert temporary.suffix == path.suffix
        temporary.write_text("whole")
        assert not path.exists()
    assert path.read_text() == "whole"
    assert names(tmp_path) == ["answer.json"]


def test_readers_see_the_old_file_until_the_new_one_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "answer.json"
    path.write_text("old")
    with appearing(path) as temporary:
        temporary.write_text("ne")
        assert path.read_text() == "old"
        temporary.write_text("new")
    assert path.read_text() == "new"
    assert names(tmp_path) == ["answer.json"]


def fail_halfway(path: Path, error: type[BaseException]) -> None:
    path.write_text("half")
    raise error


@pytest.mark.parametrize("error", [ValueError, OSError, KeyboardInterrupt])
def test_a_failure_changes_nothing(error: type[BaseException], tmp_path: Path) -> None:
    path = tmp_path / "answer.json"
    for before in ([], ["answer.json"]):
        with pytest.raises(error), appearing(path) as temporary:
            fail_halfway(temporary, error)
        assert names(tmp_path) == before
        path.write_text("old")
    assert path.read_text() == "old"


@pytest.mark.parametrize("umask", [0o022, 0o027, 0o077, 0])
def test_rights_are_those_of_any_new_file(umask: int, tmp_path: Path) -> None:
    before = os.umask(umask)
    try:
        with appearing(tmp_path / "made") as temporary:
            temporary.write_text("")
            assert not stat.S_IMODE(temporary.stat().st_mode) & 0o077  # nobody else's while it is half
        (tmp_path / "plain").touch()
    finally:
        assert os.umask(before) == umask
    assert (tmp_path / "made").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), appearing(tmp_path / "nowhere" / "file"):
        raise AssertionError("the block must not run")
    assert not names(tmp_path)


def test_a_folder_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "kept").touch()
    with pytest.raises(OSError), appearing(tmp_path / "folder") as temporary:
        temporary.write_text("")
    assert names(tmp_path) == ["folder"]
    assert names(tmp_path / "folder") == ["kept"]


def test_a_writer_that_replaces_the_temporary_file_itself(tmp_path: Path) -> None:
    """As safetensors and Polars may: unlink, then write anew."""
    with appearing(tmp_path / "model") as temporary:
        temporary.unlink()
        temporary.write_text("anew")
    assert (tmp_path / "model").read_text() == "anew"


@given(st.text(alphabet="abc. ä-_%", min_size=1, max_size=30).filter(lambda name: name.strip(". ")))
@settings(deadline=None)
def test_any_name_will_do(tmp_path_factory: pytest.TempPathFactory, name: str) -> None:
    folder = tmp_path_factory.mktemp("any", numbered=True)
    with appearing(folder / name) as temporary:
        temporary.write_text("x")
    assert names(folder) == [name]
