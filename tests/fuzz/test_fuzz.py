"""Each reader on files that are damaged in two hundred ways; `make fuzz` takes ten thousand."""

from pathlib import Path

import pytest

from fuzz.dialect_reading import ENOUGH, read_drawn
from fuzz.reading import Fuzzed
from fuzz.small import SMALL
from sensorfault.logs import read
from sensorfault.logs.readers.formats import format_of
from sensorfault.logs.readers.registry import registered

FILES = 200
FEWER = {"MDF": 50}  # damage ends its process one time in ten, and asammdf takes a second to come again


@pytest.mark.parametrize("title", SMALL)
def test_a_damaged_file_is_a_log_or_one_sentence(tmp_path: Path, title: str) -> None:
    fuzzed = Fuzzed(title, tmp_path)
    files = FEWER.get(title, FILES)
    wrong = [said for number in range(files) if (said := fuzzed.one(number)) is not None]
    assert not wrong, "\n".join(wrong[:5])
    assert fuzzed.read > files / 20  # the damage is such that some still read
    assert fuzzed.refused > 0


@pytest.mark.parametrize("title", SMALL)
def test_the_sound_file_is_a_log(tmp_path: Path, title: str) -> None:
    path = SMALL[title](tmp_path)
    form = format_of(path)
    assert form is not None
    assert title.split(",")[0] in (form.title, "gzip")
    log = read(path)
    assert len(log) >= 3
    assert not log.damage


def test_text_tables_in_any_dialect(tmp_path: Path) -> None:
    tally = read_drawn(tmp_path, FILES)
    assert tally.read + tally.refused.total() >= FILES
    assert tally.share >= ENOUGH, tally.refused.most_common(5)


def test_every_format_is_fuzzed() -> None:
    forgotten = {form.title for form in registered()} - {title.split(",")[0] for title in SMALL}
    assert not forgotten, f"no small file of {', '.join(sorted(forgotten))}; add a module to tests/fuzz/small"
