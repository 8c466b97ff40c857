"""How a format registers itself, and who takes a file that several formats could be."""

import subprocess
import sys
from collections.abc import Iterator
from fnmatch import fnmatchcase
from itertools import combinations
from pathlib import Path

import pytest

from sensorfault.logs import LogError, readers
from sensorfault.logs.readers.format import Format
from sensorfault.logs.readers.formats import format_of, known_format
from sensorfault.logs.readers.registry import registered, suffixes

GUEST = """
from pathlib import Path
from sensorfault.logs.readers.format import Format
def read(path, ask):
    return {}
"""


@pytest.fixture
def guests(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    """A folder in which readers are looked for, too."""
    monkeypatch.setattr(readers, "__path__", [*readers.__path__, str(tmp_path)])
    registered.cache_clear()
    yield tmp_path
    for name in [name for name in sys.modules if name.startswith("sensorfault.logs.readers.guest")]:
        del sys.modules[name]
    registered.cache_clear()


def test_a_new_format_is_one_file(guests: Path) -> None:
    (guests / "guest.py").write_text(GUEST + "FORMAT = Format('Guest', ('*.guest',), read)\n")
    (guests / "guest_two.py").write_text(GUEST + "FORMATS = tuple(Format(n, (f'*.{n}',), read) for n in ('u', 'v'))\n")
    assert {"Guest", "u", "v", "text table", "NMEA"} <= {form.title for form in registered()}
    assert known_format(Path("x.guest")).title == "Guest"
    assert {".guest", ".u", ".v"} <= set(suffixes())
    with pytest.raises(LogError, match=r"nothing here reads '.odd'; give one of .*\.guest, "):
        known_format(Path("x.odd"))


def test_a_library_is_loaded_only_to_read(guests: Path) -> None:
    (guests / "guest_load.py").write_text("import no_such_library\n")
    assert len(registered()) >= 22


def test_two_formats_of_one_title_are_refused(guests: Path) -> None:
    (guests / "guest.py").write_text(GUEST + "FORMAT = Format('NMEA', ('*.guest',), read)\n")
    with pytest.raises(TypeError, match="two formats are called NMEA"):
        registered()


def test_nothing_slow_is_imported_to_find_them() -> None:
    code = (
        "import sys\n"
        "from sensorfault.logs.readers.registry import registered\n"
        "assert len(registered()) >= 22\n"
        "print(*sorted({name.split('.')[0] for name in sys.modules}))\n"
    )
    loaded = set(
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    )
    slow = {"asammdf", "can", "cantools", "h5py", "mcap", "pymavlink", "pynmeagps", "pyulog", "rosbags", "scipy", "jax"}
    assert "polars" in loaded
    assert not loaded & slow


def share(one: Format, other: Format) -> bool:
    """Whether a file can have a name of both: each pattern as a name, its digits and letters filled in."""
    names = (name.replace("[0-9]", "7").replace("[nglp]", "n").replace("*", "x") for name in one.names)
    return any(fnmatchcase(name, pattern) for name in names for pattern in other.names)


def test_no_two_formats_can_both_take_a_file() -> None:
    tied = [
        f"{one.title} and {other.title}"
        for one, other in combinations(registered(), 2)
        if share(one, other) and (one.looks is None) == (other.looks is None) and one.priority == other.priority
    ]
    assert not tied, f"give one of two a priority: {'; '.join(tied)}"


@pytest.mark.parametrize(
    ("name", "head", "title"),
    [
        ("x.log", b"\x00nothing", "ArduPilot DataFlash text"),
        ("x.log", b"$GNGGA,120000,48.1,N\r\n$GNRMC,120000\r\n", "NMEA"),
        ("x.txt", b"1,2\n", "text table"),
        ("x.dat", b"MDF     4.10", "MDF"),
        ("x.rnx", b"nothing", "RINEX observations"),
        ("x.rnx", f"{'     3.04           N: GNSS NAV DATA':60}RINEX VERSION / TYPE\n".encode(), "RINEX navigation"),
    ],
)
def test_who_takes_a_shared_name(tmp_path: Path, name: str, head: bytes, title: str) -> None:
    path = tmp_path / name
    path.write_bytes(head)
    form = format_of(path)
    assert form is not None
    assert form.title == title
