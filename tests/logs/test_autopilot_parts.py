"""An autopilot's log read part by part is the log read whole, and so is what is said of it."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from logs import written_ardupilot, written_dataflash, written_ulog
from logs.small_parts import small_parts
from sensorfault.logs import Log, guess, read
from sensorfault.logs.parts import read_parts

CONTENT = {
    ".ulg": written_ulog.flight(20.0),
    ".bin": written_dataflash.flight(2, 20.0),
    ".log": written_ardupilot.text(20.0).encode(),
    ".tlog": written_ardupilot.tlog(60.0),
}


@pytest.fixture(autouse=True)
def in_small_parts() -> Iterator[None]:
    with small_parts():
        yield


def put(folder: Path, suffix: str, content: bytes) -> Path:
    path = folder / f"flight{suffix}"
    path.write_bytes(CONTENT[suffix])
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    path.write_bytes(content)
    return path


def assert_whole(path: Path) -> list[str]:
    whole, parts = read(path), list[Log]()
    said = read_parts(path, parts.append).notes
    assert len(parts) > 5
    assert all(part.channels == whole.channels and part.epoch_s == pytest.approx(whole.epoch_s) for part in parts)
    np.testing.assert_allclose(np.concatenate([part.time for part in parts]), whole.time, atol=1e-6)
    np.testing.assert_array_equal(np.concatenate([part.value for part in parts]), whole.value)
    np.testing.assert_array_equal(np.concatenate([part.fresh for part in parts]), whole.fresh)
    assert set(whole.damage) <= set(said)
    return list(said)


@pytest.mark.parametrize("suffix", CONTENT)
def test_parts_are_the_whole(tmp_path: Path, suffix: str) -> None:
    assert_whole(put(tmp_path, suffix, CONTENT[suffix]))


@pytest.mark.parametrize("suffix", CONTENT)
def test_damage_is_said_at_its_place_in_the_file(tmp_path: Path, suffix: str) -> None:
    content = CONTENT[suffix]
    at = 3 * len(content) // 4
    said = assert_whole(put(tmp_path, suffix, content[:at] + b"\n" + b"\x00" * 58 + b"\n" + content[at + 60 :]))
    place = content[:at].count(b"\n") + 1 if suffix == ".log" else at
    (where,) = (re.search(r"(?:line|byte) (\d+)", note) for note in said if "the others were read" in note)
    assert where is not None
    assert place - 200 < int(where[1]) < place + 2000


@pytest.mark.parametrize("cut", [1, 2, 3, 17, 800])
@pytest.mark.parametrize("suffix", CONTENT)
def test_a_file_that_breaks_off_is_read_so_far(tmp_path: Path, suffix: str, cut: int) -> None:
    assert any(
        "breaks off" in note or "no whole message" in note
        for note in assert_whole(put(tmp_path, suffix, CONTENT[suffix][:-cut]))
    )
