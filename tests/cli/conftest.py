"""A small drive as a CSV file, and the command line as a user meets it."""

import csv
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import fitted
from sensorfault.cli import main, studies
from sensorfault.logs.table import Log


@dataclass(frozen=True)
class Said:
    """What a command answered."""

    code: int
    out: str
    err: str


Run = Callable[..., Said]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run a command in an empty folder of its own. An error that is no sentence comes through as what it is."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")

    def command(*words: object) -> Said:
        monkeypatch.setattr(sys, "argv", ["sensorfault", *map(str, words)])
        code = 0
        try:
            main()
        except SystemExit as end:
            code = int(end.code or 0)
        said = capsys.readouterr()
        return Said(code, said.out, said.err)

    return command


@dataclass(frozen=True)
class Offer:
    """An entry point that gives this, or raises it."""

    given: object
    value: str = "somewhere:thing"
    name: str = "tests"
    dist: None = None

    def load(self) -> object:
        if isinstance(self.given, Exception):
            raise self.given
        return self.given


Install = Callable[..., None]


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch) -> Install:
    """Make the only installed studies those of entry points that give these."""

    def only(*given: object) -> None:
        monkeypatch.setattr(studies, "entry_points", lambda group: [Offer(one) for one in given])

    return only


def write_csv(path: Path, log: Log) -> Path:
    """As a recorder would: seconds, deg/s, m/s^2 and metres under plain names; nothing where nothing came."""
    names = ["time_s", *(f"gyro_{a}" for a in "xyz"), *(f"acc_{a}" for a in "xyz"), "east_m", "north_m"]
    units = np.array([180 / np.pi] * 3 + [1.0] * 5)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        for time, row in zip(log.time, log.value * units, strict=True):
            writer.writerow([f"{time:.3f}", *("" if np.isnan(x) else f"{x:.6f}" for x in row)])
    return path


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """80 s of the rig."""
    folder = tmp_path_factory.mktemp("recorded")
    return write_csv(folder / "drive.csv", fitted.rig().between(end_s=80.0)).read_bytes()


@pytest.fixture
def drive(tmp_path: Path, recorded: bytes) -> Path:
    """drive.csv in the folder that commands run in."""
    (tmp_path / "drive.csv").write_bytes(recorded)
    return Path("drive.csv")


@pytest.fixture(scope="session")
def fitted_model(recorded: bytes, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A model of the first 60 s of the drive."""
    from sensorfault.logs import read
    from sensorfault.methods.fit import fit
    from sensorfault.runtime.store import save

    folder = tmp_path_factory.mktemp("fitted")
    (folder / "drive.csv").write_bytes(recorded)
    save(fit(read(folder / "drive.csv").between(end_s=60.0)), folder / "car.sensorfault")
    return (folder / "car.sensorfault").read_bytes()


@pytest.fixture
def car(tmp_path: Path, fitted_model: bytes) -> Path:
    """car.sensorfault in the folder that commands run in."""
    (tmp_path / "car.sensorfault").write_bytes(fitted_model)
    return Path("car.sensorfault")


def refusal(said: Said) -> str:
    """The one sentence of a refusal; what precedes it are notes and progress, indented or named for what they are."""
    assert said.code == 2, said
    assert said.out == ""
    assert "Traceback" not in said.err
    lines = said.err.splitlines()
    ours = [line for line in lines if line.startswith("sensorfault: ")]
    assert ours == lines[-1:], said.err
    return ours[0]
