import struct
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, VehicleFile, read
from sensorfault.logs.readers.gps_time import leap_seconds, unix_from_gps_week

HEAD = (
    "% program   : RTKPOST ver.2.4.3\n% pos mode  : kinematic\n%\n"
    "%  {clock}                  latitude(deg) longitude(deg)  height(m)   Q  ns   vn(m/s)\n"
)
START = datetime(2025, 7, 8, 19, 34, 18, 500_000, tzinfo=UTC).timestamp()


@pytest.mark.parametrize(
    ("clock", "first", "second", "ahead"),
    [
        ("GPST", "2025/07/08 19:34:18.500", "2025/07/08 19:34:18.750", 18.0),
        ("UTC ", "2025/07/08 19:34:18.500", "2025/07/08 19:34:18.750", 0.0),
        ("GPST", "2374 243258.500", "2374 243258.750", 18.0),
    ],
)
def test_a_solution_file(tmp_path: Path, clock: str, first: str, second: str, ahead: float) -> None:
    path = tmp_path / "drive.pos"
    path.write_text(
        HEAD.format(clock=clock)
        + f"{first}   40.0966268 -105.1474483  1601.4740   1  21   0.0100\n"
        + f"{second}   40.0966270 -105.1474481  1601.4760   1  21   1.2500\n"
    )
    log = read(path)
    assert log.epoch_s == pytest.approx(START - ahead, abs=1e-6)
    np.testing.assert_allclose(log.time, [0, 0.25], atol=1e-6)
    assert {channel.path for channel in log.channels} >= {
        "gnss.latitude",
        "gnss.longitude",
        "gnss.north",
    }
    np.testing.assert_allclose(np.degrees(log.value[:, log.index("latitude")]), [40.0966268, 40.0966270], rtol=1e-14)
    np.testing.assert_allclose(log.value[:, log.index("north")], [0.01, 1.25])


@pytest.mark.parametrize(
    ("day", "seconds"),
    [
        ("1980-01-06", 0),
        ("1981-06-30", 0),
        ("1981-07-01", 1),
        ("2016-12-31", 17),
        ("2017-01-01", 18),
        ("2025-07-08", 18),
    ],
)
def test_leap_seconds(day: str, seconds: int) -> None:
    assert leap_seconds(datetime.fromisoformat(day).replace(tzinfo=UTC).timestamp()) == seconds


def test_gps_weeks() -> None:
    assert unix_from_gps_week(0.0, 0.0) == datetime(1980, 1, 6, tzinfo=UTC).timestamp()
    assert unix_from_gps_week(2374.0, 243258.5) == START - 18


def recording(folder: Path, end: bytes, strip: bool, delay_s: float = 0.004, drift: float = 1e-3) -> np.ndarray:
    """A stream of lines with a counter, and the tags of a host that polls it; returns each line's Unix time."""
    counter_ms = 5000 + 10 * np.arange(3000)
    born = 3.0 + (counter_ms - counter_ms[0]) / 1e3 * (1 + drift)  # seconds since the host's start
    lines = [f"0.01,{k % 13},{ms}".encode() + end for k, ms in enumerate(counter_ms)]
    position = np.cumsum([len(line) for line in lines])
    pairs = b""
    for tick in range(3000, 34000, 15):  # every 15 ms: so many bytes have come
        come = int(np.searchsorted(born + delay_s, tick / 1e3, side="right"))
        if come:
            pairs += struct.pack("<II", tick, int(position[come - 1]))
    (folder / "imu.csv").write_bytes(b"".join(lines).replace(b"\r\n", b"\n") if strip else b"".join(lines))
    header = b"TIMETAG RTKLIB demo5".ljust(60, b"\0") + struct.pack("<I", 77)
    (folder / "imu.csv.tag").write_bytes(header + struct.pack("<Id", int(START), START % 1) + pairs)
    return np.asarray(START - 18 + born)


VEHICLE = '[file.imu]\ntime = "c3"\nunit = "ms"\ntag = "imu.csv.tag"\n[sensor.s.channel]\na = { column = "c2" }\n'


@pytest.mark.parametrize(("end", "strip"), [(b"\n", False), (b"\r\n", False), (b"\r\n", True)])
def test_a_time_tag_puts_a_counter_on_gps_time(tmp_path: Path, end: bytes, strip: bool) -> None:
    born = recording(tmp_path, end, strip)
    log = read(tmp_path / "imu.csv", VehicleFile.parse(VEHICLE))
    assert log.epoch_s is not None
    late = log.epoch_s + log.time - born  # a line is dated by when it was seen: 4 ms on the way, 0 to 15 ms of waiting
    assert late.min() > 0.004
    assert late.max() < 0.019
    assert late.max() - late.min() < 0.002
    assert any("gives its counter GPS time" in note and "ppm slow" in note for note in log.notes)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"something else", "not a time tag"),
        (b"TIMETAG RTKLIB demo5".ljust(76, b"\0") + struct.pack("<IIII", 1, 5, 2, 10**6), "bytes but imu.csv has"),
    ],
)
def test_a_wrong_time_tag(tmp_path: Path, content: bytes, sentence: str) -> None:
    recording(tmp_path, b"\n", False)
    (tmp_path / "imu.csv.tag").write_bytes(content)
    with pytest.raises(LogError, match=sentence):
        read(tmp_path / "imu.csv", VehicleFile.parse(VEHICLE))


def test_a_time_tag_that_is_not_there(tmp_path: Path) -> None:
    recording(tmp_path, b"\n", False)
    (tmp_path / "imu.csv.tag").unlink()
    with pytest.raises(LogError, match="no time tag"):
        read(tmp_path / "imu.csv", VehicleFile.parse(VEHICLE))
