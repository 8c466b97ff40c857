"""The house of the readers: who opens what, what is asked, and how damage comes to the user."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest

from sensorfault.cli import cli, work
from sensorfault.logs import VehicleFile, guess, read
from sensorfault.logs.readers import formats
from sensorfault.logs.readers.formats import Format, format_of
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, with_notes

DESCRIBED = '[file.log]\ntime = "t"\ntable = "b"\n[sensor.s.channel]\na = { column = "a", unit = "m/s" }\n'


def two_tables(path: Path, ask: Ask) -> Tables:
    ask.tell(0.5)
    time = np.arange(50.0) / 10
    names = [name for name in ("a", "b") if ask.wants(name)]
    frames = {name: pl.DataFrame({"t": time, "a": np.sin(time)}) for name in names}
    asked.append(ask.tables)
    tables = {name: Source(path, frame, "t", "s") for name, frame in frames.items()}
    return with_notes(
        tables, ["log.odd: topics of unknown type left out: /x."], [Damage("the file breaks off", "byte 7")]
    )


asked: list[frozenset[str] | None] = []


@pytest.fixture(autouse=True)
def odd(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    asked.clear()
    other = Format("odd", ("*.odd",), lambda path, ask: {}, looks=lambda head: head.startswith(b"no"))
    ours = Format("two tables", ("*.odd", "*.odd.[0-9]"), two_tables)
    every = (*formats.registered(), other, ours)
    monkeypatch.setattr(formats, "registered", lambda: every)
    path = tmp_path / "log.odd"
    path.write_bytes(b"anything")
    return path


def test_a_name_that_two_formats_share_is_told_by_the_beginning(odd: Path) -> None:
    assert format_of(odd).title == "two tables"
    assert format_of(odd.with_name("log.odd.3")).title == "two tables"
    odd.write_bytes(b"no")
    assert format_of(odd).title == "odd"


def test_damage_is_told_once_and_kept_apart(odd: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert asked == []
    log = read(odd)
    assert log.damage == ("log.odd: the file breaks off at byte 7; what came before was read.",)
    assert log.notes.count(log.damage[0]) == 1
    assert log.notes.count("log.odd: topics of unknown type left out: /x.") == 1
    assert guess(odd).notes[:2] == (log.damage[0], "log.odd: topics of unknown type left out: /x.")
    work.read_log(odd, None)
    assert capsys.readouterr().err.count("breaks off at byte 7") == 1


def test_only_the_described_tables_are_read(odd: Path) -> None:
    assert len(read(odd, VehicleFile.parse(DESCRIBED))) == 50
    assert asked == [frozenset({"b"})]


def test_the_share_read_is_heard(odd: Path) -> None:
    received: list[float] = []
    read(odd, VehicleFile.parse(DESCRIBED), tell=received.append)
    assert received == [0.5]


def test_init_tells_the_damage(odd: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli(["init", str(odd)], standalone_mode=False)
    assert "breaks off at byte 7" in capsys.readouterr().err
    assert "breaks off at byte 7" in odd.with_name("vehicle.toml").read_text()
