"""Mistakes made once on the command line: each of these failed before it was mended."""

from pathlib import Path

import pytest

from cli.conftest import Run


def test_the_log_that_is_read_is_not_written_over(run: Run, drive: Path) -> None:
    before = drive.read_bytes()
    assert run("inject", drive, "--fault", "missing:gyro:1:1", "--out", drive).code == 2
    assert run("fit", drive, "--out", drive).code == 2
    assert drive.read_bytes() == before


def test_inject_writes_all_or_nothing(run: Run, drive: Path) -> None:
    Path("bad.truth.json").mkdir()
    assert run("inject", drive, "--fault", "missing:gyro:1:1", "--out", "bad.csv").code == 2
    assert not Path("bad.csv").exists()


def test_a_truth_that_is_no_text_is_a_sentence(run: Run, drive: Path, car: Path) -> None:
    Path("noise.json").write_bytes(bytes(range(128, 256)))
    said = run("report", drive, "--model", car, "--truth", "noise.json")
    assert said.code == 2
    assert "noise.json: not a text file" in said.err


@pytest.mark.parametrize(("verb", "option", "value"), [
    ("evaluate", "--duration", "-5"),
    ("evaluate", "--duration", "nan"),
    ("detect", "--learn", "nan"),
    ("fit", "--held-out", "1e-7"),
])  # fmt: skip
def test_numbers_that_make_no_sense_are_a_sentence(run: Run, drive: Path, verb: str, option: str, value: str) -> None:
    assert run(verb, drive, option, value).code == 2


def test_a_bad_cell_is_left_out_and_named(run: Run, drive: Path) -> None:
    lines = drive.read_text().splitlines()
    cells = lines[1001].split(",")
    cells[2] = "wet"
    lines[1001] = ",".join(cells)
    drive.write_text("\n".join(lines) + "\n")
    said = run("info", drive)
    assert said.code == 0
    assert "line 1002" in said.err
    assert "wet" in said.err


def test_an_empty_column_that_is_left_out_is_mentioned(run: Run, drive: Path) -> None:
    head, *rows = [line.split(",") for line in drive.read_text().splitlines()]
    for row in rows:
        row[3] = ""
    drive.write_text("\n".join(",".join(row) for row in (head, *rows)) + "\n")
    assert f"{head[3]} (holds no value at all)" in run("detect", drive).err


def test_messages_name_the_path_that_was_asked_for(run: Run, drive: Path, car: Path) -> None:
    for words in (
        ("fit", drive, "--out", "nowhere/m.sensorfault"),
        ("report", drive, "--model", car, "--out", "nowhere/x.html"),
        ("methods", "--json", "nowhere/x.json"),
    ):
        said = run(*words)
        assert said.code == 2
        assert said.err.splitlines()[-1].startswith(f"sensorfault: {words[-1]}: ")
