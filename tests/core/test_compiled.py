"""Compiled programs on disk: whole or dropped, bounded, private; with them and without, the same bits."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from sensorfault.core.compiled import OWN, VARIABLE, Programs, Unusable, folder, machine

PROGRAM = """
import sensorfault.core._jax
import jax, jax.numpy as jnp, numpy as np
hits = []
jax.monitoring.register_event_listener(lambda name, **_: hits.append(name) if name.endswith("cache_hits") else None)
x = jnp.asarray(np.linspace(0.0, 7.0, 999))
y = jax.jit(lambda x: jnp.cumsum(jnp.sin(x) @ jnp.outer(x, x)) / 3.0)(x)
print(len(hits), np.asarray(y).tobytes().hex())
"""


@pytest.fixture
def programs(tmp_path: Path) -> Programs:
    found = Programs(tmp_path / "here" / "compiled", most_bytes=1000)
    found.prepare()
    return found


def test_what_is_put_is_got(programs: Programs) -> None:
    assert programs.get("a") is None
    programs.put("a", b"program")
    programs.put("b", b"")
    assert programs.get("a") == b"program"
    assert programs.get("b") == b""
    assert programs.clear() == 2
    assert programs.get("a") is None


def test_the_folder_and_its_files_are_the_users_own(programs: Programs) -> None:
    programs.put("a", b"program")
    assert stat.S_IMODE(programs.home.stat().st_mode) == 0o700
    (file,) = programs.home.iterdir()
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    programs.home.chmod(0o755)
    programs.prepare()
    assert stat.S_IMODE(programs.home.stat().st_mode) == 0o700


@pytest.mark.parametrize("damage", [lambda b: b[:-1], lambda b: b"", lambda b: b[:40] + b"x" + b[41:], lambda b: b * 2])
def test_a_damaged_entry_is_dropped(programs: Programs, damage) -> None:
    programs.put("a", b"a program of some length")
    (file,) = programs.home.iterdir()
    file.write_bytes(damage(file.read_bytes()))
    assert programs.get("a") is None
    assert not file.exists()


def test_an_entry_of_another_key_is_dropped(programs: Programs) -> None:
    programs.put("a", b"program")
    (file,) = programs.home.iterdir()
    file.rename(programs._path("b"))
    assert programs.get("b") is None


def test_the_longest_unused_go_first(programs: Programs) -> None:
    for number in range(5):
        programs.put(str(number), bytes(150))
        os.utime(programs._path(str(number)), (number, number))
    assert programs.get("0") is not None  # used now
    programs.put("5", bytes(150))
    assert [programs.get(str(n)) is not None for n in range(6)] == [True, False, False, True, True, True]
    programs.put("huge", bytes(1001))
    assert programs.get("huge") is None
    assert programs.get("5") is not None


def test_a_link_or_a_file_is_not_used(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path)
    with pytest.raises(Unusable, match="is a link or belongs to another user"):
        Programs(tmp_path / "link").prepare()
    (tmp_path / "file").write_text("")
    with pytest.raises(Unusable, match="cannot be used"):
        Programs(tmp_path / "file").prepare()


def test_where_it_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "off")
    assert folder() is None
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert folder() == tmp_path / OWN
    monkeypatch.delenv(VARIABLE)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    found = folder()
    assert found is not None
    assert found.name == "compiled"
    assert "sensorfault" in found.parts
    assert machine() == machine()


def run(**environment: str) -> tuple[int, str, str]:
    """Hits, the answer's bytes, and what was said on the terminal."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("JAX_", VARIABLE))}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=kept | environment, capture_output=True, text=True, check=True
    )
    hits, answer = done.stdout.split()
    return int(hits), answer, done.stderr


def test_answers_are_the_same_to_the_bit_and_damage_is_not_noticed(tmp_path: Path) -> None:
    home = tmp_path / OWN
    without = run(**{VARIABLE: "off"})
    first, second = (run(**{VARIABLE: str(tmp_path)}) for _ in range(2))
    assert without[0] == first[0] == 0 < second[0]
    assert without[1] == first[1] == second[1]
    for file in home.iterdir():
        file.write_bytes(file.read_bytes()[:100])
    third = run(**{VARIABLE: str(tmp_path)})
    assert third == (0, without[1], first[2])
    assert run(**{VARIABLE: str(tmp_path)})[0] == second[0]


def test_a_program_that_keeps_its_own_is_left_alone(tmp_path: Path) -> None:
    hits, _, _ = run(JAX_COMPILATION_CACHE_DIR=str(tmp_path / "jax"), **{VARIABLE: str(tmp_path / "ours")})
    assert hits == 0
    assert not (tmp_path / "ours").exists()


def test_a_folder_that_cannot_be_used_costs_nothing_but_time(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("precious")
    assert run(**{VARIABLE: str(tmp_path / "file")})[1] == run(**{VARIABLE: "off"})[1]
    assert (tmp_path / "file").read_text() == "precious"
