"""What a user gets wrong: one sentence, exit code 2, no traceback, nothing half-written and nothing lost."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.conftest import Run, Said, refusal


def listing(folder: Path) -> dict[str, bytes | None]:
    """Every file with its content, every folder."""
    return {str(f.relative_to(folder)): f.read_bytes() if f.is_file() else None for f in sorted(folder.rglob("*"))}


def lines_of(drive: Path) -> list[str]:
    return drive.read_text().splitlines()


def rewrite(change: Callable[[list[str]], list[str]]) -> Callable[[Path], None]:
    def do(drive: Path) -> None:
        drive.write_text("\n".join(change(lines_of(drive))) + "\n")

    return do


def cells(change: Callable[[int, list[str]], list[str]]) -> Callable[[Path], None]:
    return rewrite(lambda lines: [lines[0], *(",".join(change(i, x.split(","))) for i, x in enumerate(lines[1:]))])


def put(column: int, text: str, rows: Callable[[int], bool]) -> Callable[[Path], None]:
    return cells(lambda i, row: [*row[:column], text, *row[column + 1 :]] if rows(i) else row)


# What is done to drive.csv, and words that the sentence must have.
BAD_LOGS: dict[str, tuple[Callable[[Path], None], tuple[str, ...]]] = {
    "empty": (lambda drive: drive.write_text(""), ("drive.csv",)),
    "only a header": (rewrite(lambda lines: lines[:1]), ("drive.csv",)),
    "one row": (rewrite(lambda lines: lines[:2]), ("drive",)),
    "three rows": (rewrite(lambda lines: lines[:4]), ("drive",)),
    "no time column": (rewrite(lambda lines: [line.split(",", 1)[1] for line in lines]), ("drive.csv", "time")),
    "binary": (lambda drive: drive.write_bytes(bytes(range(256)) * 50), ("drive.csv",)),
    "a channel without a value": (put(3, "", lambda i: True), ("drive.csv", "gyro_z")),
    "unsorted time": (rewrite(lambda lines: [lines[0], *lines[2001:], *lines[1:2001]]), ("drive.csv", "line 2002")),
    "a log of time alone": (rewrite(lambda lines: [line.split(",")[0] for line in lines]), ("drive.csv",)),
}


@pytest.fixture
def described(run: Run, drive: Path) -> Path:
    """A description of the good drive, so that nothing is guessed from the bad one."""
    assert run("init", drive, "--out", "v.toml").code == 0
    return Path("v.toml")


@pytest.mark.parametrize("what", BAD_LOGS)
@pytest.mark.parametrize("verb", ["fit", "detect"])
def test_bad_logs(what: str, verb: str, run: Run, drive: Path, described: Path, tmp_path: Path) -> None:
    damage, words = BAD_LOGS[what]
    damage(drive)
    before = listing(tmp_path)
    result = refusal(run(verb, drive, "--vehicle", described))
    assert result.endswith(".")
    assert all(word in result for word in words), result
    assert listing(tmp_path) == before


@pytest.mark.parametrize(
    "what", ["empty", "only a header", "one row", "binary", "no time column", "a log of time alone"]
)
def test_no_log_at_all(what: str, run: Run, drive: Path, tmp_path: Path) -> None:
    """Neither to judge nor to guess from."""
    BAD_LOGS[what][0](drive)
    before = listing(tmp_path)
    for verb in ("detect", "init"):
        assert "drive.csv" in refusal(run(verb, drive))
        assert listing(tmp_path) == before


def test_infinite_values_are_no_values_and_told(run: Run, drive: Path, described: Path) -> None:
    put(1, "inf", lambda i: i % 100 == 5)(drive)
    said = run("detect", drive, "--vehicle", described)
    assert said.code == 0, said.err
    assert "drive.csv: cells are infinite in 'gyro_x' (40), first in line 7" in said.err


COMMANDS: dict[str, tuple[str, ...]] = {
    "unknown log": ("detect", "nowhere.csv"),
    "unknown log for init": ("init", "nowhere.csv"),
    "unknown log for fit": ("fit", "nowhere.csv"),
    "unknown log for inject": ("inject", "nowhere.csv", "--fault", "missing:gyro:1:1", "--out", "x.csv"),
    "unknown folder": ("detect", "no/where"),
    "a folder without logs": ("detect", "empty"),
    "a log of another kind": ("detect", "notes.pdf"),
    "unknown vehicle file": ("detect", "drive.csv", "--vehicle", "nowhere.toml"),
    "a vehicle file that is none": ("detect", "drive.csv", "--vehicle", "drive.csv"),
    "unknown model": ("detect", "drive.csv", "--model", "nowhere.sensorfault"),
    "a model that is none": ("detect", "drive.csv", "--model", "drive.csv"),
    "a model for other channels": ("detect", "other.csv", "--model", "car.sensorfault"),
    "a model for another rate": ("detect", "slow.csv", "--model", "car.sensorfault"),
    "unknown method": ("detect", "drive.csv", "--method", "lstm"),
    "unknown method for fit": ("fit", "drive.csv", "--method", "lstm"),
    "unknown method for demo": ("demo", "--method", "lstm"),
    "unknown fault": ("inject", "drive.csv", "--fault", "melt:gyro:1:1", "--out", "x.csv"),
    "unknown sensor": ("inject", "drive.csv", "--fault", "missing:radar:1:1", "--out", "x.csv"),
    "unknown channel": ("inject", "drive.csv", "--fault", "frozen:gyro.w:1:1", "--out", "x.csv"),
    "a fault of too few parts": ("inject", "drive.csv", "--fault", "frozen", "--out", "x.csv"),
    "a fault beyond the log": ("inject", "drive.csv", "--fault", "frozen:gyro:1000:1", "--out", "x.csv"),
    "a fault without a size": ("inject", "drive.csv", "--fault", "offset:gyro:1:1", "--out", "x.csv"),
    "no fault": ("inject", "drive.csv", "--out", "x.csv"),
    "no output": ("inject", "drive.csv", "--fault", "missing:gyro:1:1"),
    "an output of another kind": ("inject", "drive.csv", "--fault", "missing:gyro:1:1", "--out", "x.xls"),
    "unknown truth": ("evaluate", "drive.csv", "--truth", "nowhere.json"),
    "a truth that is none": ("evaluate", "drive.csv", "--truth", "drive.csv"),
    "a truth of other keys": ("report", "drive.csv", "--truth", "odd.json"),
    "init over an existing file": ("init", "drive.csv", "--out", "kept.toml"),
    "unknown verb": ("repair", "drive.csv"),
    "unknown option": ("detect", "drive.csv", "--loud"),
    "no log": ("detect",),
    "two logs": ("detect", "drive.csv", "other.csv"),
    "a share that is none": ("detect", "drive.csv", "--learn", "1.5"),
    "a share held out that is none": ("fit", "drive.csv", "--held-out", "1.5"),
    "a seed that is none": ("fit", "drive.csv", "--seed", "-1"),
    "until before the beginning": ("fit", "drive.csv", "--until", "-5"),
    "faults longer than the log": ("evaluate", "drive.csv", "--model", "car.sensorfault", "--duration", "500"),
    "no folder for the model": ("fit", "drive.csv", "--out", "no/where/car.sensorfault"),
    "no folder for the log": ("inject", "drive.csv", "--fault", "missing:gyro:1:1", "--out", "no/where/x.csv"),
    "no folder for the page": ("report", "drive.csv", "--model", "car.sensorfault", "--out", "no/where/x.html"),
    "no folder for the vehicle file": ("init", "drive.csv", "--out", "no/where/vehicle.toml"),
    "no folder for JSON": ("methods", "--json", "no/where/methods.json"),
    "a folder for the model": ("fit", "drive.csv", "--out", "empty"),
    "a folder for the page": ("report", "drive.csv", "--model", "car.sensorfault", "--out", "empty"),
    "a folder for JSON": ("methods", "--json", "empty"),
}


@pytest.mark.parametrize("case", COMMANDS)
def test_bad_commands(case: str, run: Run, drive: Path, car: Path, tmp_path: Path) -> None:
    lines = lines_of(drive)
    Path("empty").mkdir()
    Path("notes.pdf").write_bytes(b"%PDF")
    Path("odd.json").write_text('[{"kind": "bias", "colour": "red"}]')
    Path("kept.toml").write_text("# mine\n")
    Path("other.csv").write_text("\n".join([lines[0].replace("gyro", "mag"), *lines[1:]]) + "\n")
    Path("slow.csv").write_text("\n".join([lines[0], *lines[1::10]]) + "\n")
    before = listing(tmp_path)
    refusal_ = run(*COMMANDS[case])
    if case in ("a folder for JSON", "no folder for JSON"):  # the table stands already when the file cannot be written
        refusal_ = Said(refusal_.code, "", refusal_.err)
    result = refusal(refusal_)
    assert listing(tmp_path) == before, "a file appeared or changed"
    for word in COMMANDS[case][1:]:  # what was wrong is named
        if word.startswith("no") and "." in word:
            assert Path(word).name.split(".")[0] in result, result


def test_existing_answers_survive_a_failure(run: Run, drive: Path, described: Path, tmp_path: Path) -> None:
    """Every output is there already; every command fails; every output is as it was."""
    good = drive.read_bytes()
    for name in ("car.sensorfault", "page.html", "found.json", "faulty.csv", "faulty.truth.json"):
        Path(name).write_text("mine")
    drive.write_bytes(good.partition(b"\n")[0] + b"\n")
    before = listing(tmp_path)
    for words in (
        ("fit", drive, "--out", "car.sensorfault", "--json", "found.json"),
        ("detect", drive, "--report", "page.html", "--json", "found.json"),
        ("evaluate", drive, "--json", "found.json"),
        ("report", drive, "--out", "page.html"),
        ("inject", drive, "--fault", "missing:gyro:1:1", "--out", "faulty.csv", "--json", "found.json"),
    ):
        refusal(run(*words, "--vehicle", described))
        assert listing(tmp_path) == before


def test_a_failure_while_writing_leaves_the_old_answer(
    run: Run, drive: Path, car: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk is full: the old file stays, and no half of a new one lies about."""
    Path("found.json").write_text("mine")
    before = listing(tmp_path)
    write_text = Path.write_text

    def full(self: Path, data: str, *rest: object, **more: object) -> int:
        if not self.name.startswith(".found.json"):
            return write_text(self, data, *rest, **more)  # type: ignore[arg-type]
        write_text(self, data[: len(data) // 2])
        raise OSError(28, "No space left on device", str(self))

    monkeypatch.setattr(Path, "write_text", full)
    said = run("detect", drive, "--model", car, "--json", "found.json")
    assert said.code == 2
    assert "No space left on device" in said.err
    assert "Traceback" not in said.err
    assert listing(tmp_path) == before


def test_init_keeps_what_is_there_unless_forced(run: Run, drive: Path) -> None:
    Path("vehicle.toml").write_text("# mine\n")
    assert "--force" in refusal(run("init", drive))
    assert Path("vehicle.toml").read_text() == "# mine\n"
    assert run("init", drive, "--force").code == 0
    assert "[sensor.gyro]" in Path("vehicle.toml").read_text()


def test_a_folder_of_one_drive(run: Run, drive: Path, car: Path) -> None:
    Path("logs").mkdir()
    shutil.copy(drive, "logs")
    said = run("detect", "logs", "--model", car, "--json", "-")
    assert said.code == 0, said.err
    assert json.loads(said.out)["events"] == []
