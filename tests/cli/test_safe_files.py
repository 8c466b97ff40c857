"""Nothing of the user's is lost: no command writes over what it reads, and nothing half-written stays."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import sensorfault
from cli.conftest import Run, refusal
from sensorfault.core.files import appearing, safe_name
from sensorfault.faults.fault import FaultError
from sensorfault.faults.text import truth_from_json


@pytest.mark.parametrize(
    "words",
    [
        ("init", "drive.csv", "--json", "drive.csv"),
        ("init", "drive.csv", "--out", "drive.csv", "--force"),
        ("init", "drive.csv", "--out", "link.csv", "--force"),
        ("init", "drive.csv", "--out", "hard.csv", "--force"),
        ("info", "drive.csv", "--json", "drive.csv"),
        ("detect", "drive.csv", "--out", "link.csv"),
        ("fit", "drive.csv", "--out", "hard.csv"),
        ("inject", "drive.csv", "--fault", "spike:gyro.x:61:0:30sigma", "--out", "./drive.csv"),
        ("report", "drive.csv", "--out", "link.csv"),
        ("evaluate", "drive.csv", "--json", "hard.csv"),
    ],
    ids=" ".join,
)
def test_no_command_writes_over_its_log(words: tuple[str, ...], run: Run, drive: Path, tmp_path: Path) -> None:
    before = drive.read_bytes()
    (tmp_path / "link.csv").symlink_to(drive)
    os.link(drive, tmp_path / "hard.csv")
    assert "input" in refusal(run(*words))
    assert drive.read_bytes() == before


def test_no_file_is_written_twice(run: Run, drive: Path) -> None:
    words = "detect", drive, "--out", "found.csv", "--json", "./found.csv"
    assert "two outputs" in refusal(run(*words))


@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_no_output_but_a_file(kind: str, run: Run, drive: Path, tmp_path: Path) -> None:
    target = tmp_path / "out.json"
    if kind == "pipe":
        os.mkfifo(target)
    elif kind == "folder":
        target.mkdir()
    else:
        target = Path("/dev/full")
    assert "give a file to write" in refusal(run("info", drive, "--json", target))


@pytest.mark.parametrize("verb", ["info", "init", "detect", "fit"])
def test_a_pipe_is_refused_before_it_is_read(verb: str, run: Run, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    assert "pipe" in refusal(run(verb, tmp_path / "pipe.csv"))


def test_a_name_that_is_no_utf8_is_a_sentence(run: Run, drive: Path) -> None:
    odd = Path(os.fsdecode(os.fsencode(drive.with_name("b")) + b"\xff.csv"))
    odd.write_bytes(drive.read_bytes())
    assert "rename it" in refusal(run("info", odd))


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    real.write_text("old")
    link.symlink_to(real)
    with appearing(link) as temporary:
        temporary.write_text("new")
    assert link.is_symlink()
    assert real.read_text() == "new"


def test_a_loop_of_links_is_an_error_that_names_it(tmp_path: Path) -> None:
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    with pytest.raises(OSError, match="loop"), appearing(loop):
        pass


@pytest.mark.parametrize("name", ["../../x", "/etc/passwd", "..", "", "a b\nc"])
def test_a_name_never_leads_elsewhere(name: str) -> None:
    safe = safe_name(name)
    assert safe
    assert Path(safe).name == safe
    assert safe not in (".", "..")


def test_json_without_end_is_a_sentence() -> None:
    with pytest.raises(FaultError, match="nested"):
        truth_from_json("[" * 100_000)


def test_a_full_disk_is_a_sentence(run: Run, drive: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def full(self: Path, *args: object, **options: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    before = sorted(tmp_path.iterdir())
    said = run("info", drive, "--json", "out.json")
    assert said.code == 2
    assert "No space left" in said.err.splitlines()[-1]
    assert sorted(tmp_path.iterdir()) == before


def test_what_is_killed_leaves_no_temporary(tmp_path: Path) -> None:
    code = (
        "import sys, time, sensorfault.cli as c\n"
        "from pathlib import Path\n"
        "from sensorfault.core.files import appearing\n"
        "c._be_interruptible()\n"
        "with appearing(Path('out.txt')) as t:\n"
        "    t.write_text('half'); print('here', flush=True); time.sleep(60)\n"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(sensorfault.__file__).parents[1])}
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "here\n"
        process.send_signal(signal.SIGTERM)
        assert process.wait(20) == 128 + signal.SIGTERM
    assert list(tmp_path.iterdir()) == []


def test_control_characters_are_seen(run: Run, tmp_path: Path) -> None:
    rows = "".join(f"{0.02 * i:.2f},{i % 7},{i % 5}\n" for i in range(600))
    (tmp_path / "odd.csv").write_text("time,gyro_\x1b[31mx,b\n" + rows)
    said = run("info", tmp_path / "odd.csv")
    assert "\x1b[31m" not in said.out + said.err


def test_a_folder_of_many_files_answers_soon(run: Run, tmp_path: Path) -> None:
    many = tmp_path / "many"
    many.mkdir()
    for i in range(5_000):
        (many / f"{i}.tmp").touch()
    begun = time.monotonic()
    assert "no file in this folder can be read" in refusal(run("info", many))
    assert time.monotonic() - begun < 10
