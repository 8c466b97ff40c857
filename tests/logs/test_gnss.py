"""Raw satellite navigation from small files that other libraries or hands wrote, sound and damaged."""

import gzip
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pyubx2 import UBXReader

from fuzz.small import SMALL
from fuzz.writing import EPOCHS
from sensorfault.logs import Log, LogError, read
from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.formats import read_source
from sensorfault.logs.readers.gnss.broadcast import Broadcast
from sensorfault.logs.readers.gnss.observed import Observed
from sensorfault.logs.readers.gnss.ranges import with_satellites
from sensorfault.logs.readers.gnss.rinex import calendar_s
from sensorfault.logs.readers.gnss.rinex_nav import read_nav
from sensorfault.logs.readers.gnss.subframes import Subframes
from sensorfault.logs.readers.gzipped import read_unpacked
from sensorfault.logs.satellites import satellites
from sensorfault.numerics import geodesy
from sensorfault.numerics.gnss import atmosphere, kepler, sight
from sensorfault.numerics.gnss.constellation import walker
from sensorfault.numerics.gnss.kepler import Ephemeris

C = 299792458.0
MUNICH = np.deg2rad([48.1, 11.6])


def column(log: Log, path: str) -> np.ndarray:
    return log.value[:, log.index(path)]


def test_ubx_says_what_pyubx2_says(tmp_path: Path) -> None:
    path = SMALL["u-blox"](tmp_path)
    with path.open("rb") as file:
        said = [message for _, message in UBXReader(file) if message.identity == "RXM-RAWX"]
    log = read(path)
    assert len(log) == len(said) == 12
    for i, satellite in enumerate(("G07", "G12", "G30"), 1):
        for ours, theirs in (("pseudorange_m", "prMes"), ("doppler_hz", "doMes"), ("cn0_dbhz", "cno")):
            result = [getattr(message, f"{theirs}_{i:02}") for message in said]
            np.testing.assert_array_equal(column(log, f"{satellite}.{ours}"), result)
    assert column(log, "G07.sigma_m")[0] == pytest.approx(0.01 * 2**5)
    assert any("it has no complete ephemeris" in note for note in log.notes)
    fixes = read_source(path, "NAV-PVT").frame
    assert fixes["latitude"][1] == pytest.approx(48.10001)
    assert fixes["altitude"][0] == 512.345
    assert fixes["north"][0] == 1.5
    # 2025-08-24 00:16:22.25 UTC
    assert fixes["time"][0] == pytest.approx(1755994582.25, abs=1e-3)


def test_a_damaged_length_costs_one_message(tmp_path: Path) -> None:
    path = SMALL["u-blox"](tmp_path)
    content = bytearray(path.read_bytes())
    at = content.find(b"\xb5\x62\x02\x15", 1)
    content[at + 5] ^= 0x40  # sixteen thousand bytes longer
    path.write_bytes(content)
    log = read(path)
    assert len(log) == 11
    assert log.damage == (f"rover.ubx: a message is damaged or cut off at byte {at}; all the others were read.",)


def test_nmea_becomes_one_row_for_each_time(tmp_path: Path) -> None:
    path = SMALL["NMEA"](tmp_path)
    log = read(path)
    assert len(log) == 12
    assert log.epoch_s == pytest.approx(1756036800.0)  # 2025-08-24 12:00:00 UTC
    np.testing.assert_allclose(column(log, "gnss.speed"), 3.6 * 1852 / 3600)
    np.testing.assert_allclose(np.rad2deg(column(log, "gnss.latitude")), 48.1 + 1e-5 * np.arange(12), atol=1e-7)
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(line for line in lines if b"GGA" in line).replace(b"4,12", b"4,13", 1))
    log = read(path)
    assert len(log) == 11
    assert any("counts from midnight" in note for note in log.notes)
    assert log.damage == ("rover.nmea: 1 sentences are damaged, the first at line 1; all the others were read.",)


@pytest.mark.parametrize("title", ["RINEX observations", "RINEX observations, version 2"])
def test_rinex_of_both_versions(tmp_path: Path, title: str) -> None:
    path = SMALL[title](tmp_path)
    log = read(path)
    assert len(log) == EPOCHS
    assert log.epoch_s == pytest.approx(1756036800.0 - 18)
    assert any("no navigation file" in note for note in log.notes)
    if "2" in title:
        np.testing.assert_allclose(column(log, "R01.pseudorange_m"), 2e7 + 2 + np.arange(EPOCHS))
        np.testing.assert_allclose(column(log, "G07.doppler_hz"), -10.5)
    else:
        np.testing.assert_allclose(column(log, "G07.pseudorange_m"), 2.1e7 + np.arange(EPOCHS))
        np.testing.assert_allclose(column(log, "E30.cn0_dbhz"), 38.0)
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*lines, "\n", "  \n"]))
    assert not read(path).damage
    path.write_text("".join(lines[:-1]))
    cut = read(path)
    assert len(cut) == EPOCHS - 1
    assert cut.damage == (f"{path.name}: the file breaks off at line {len(lines) - 1}; what came before was read.",)


def test_ephemerides_beside_the_observations_give_the_places(tmp_path: Path) -> None:
    path = SMALL["RINEX observations"](tmp_path)
    SMALL["RINEX navigation"](tmp_path)
    log = read(path)
    place = np.stack([column(log, f"G07.{axis}_m") for axis in "xyz"], axis=1)
    np.testing.assert_allclose(np.linalg.norm(place, axis=1), 5153.7**2, rtol=0.011)
    sent = 1756036800.0 - 18 - 315964800.0 + 18 - column(log, "G07.pseudorange_m")[0] / C
    result = read_nav(tmp_path / "site.nav").at("G07", np.array([sent]))
    np.testing.assert_allclose(result.position, place[:1], atol=1.0)
    assert any("positions are from site.nav" in note for note in log.notes)
    alone = read(tmp_path)  # the folder is one log: its navigation file is no log beside it
    assert [sensor.name for sensor in alone.sensors] == [sensor.name for sensor in log.sensors]


def test_corrected_ranges_hold_the_distance_and_the_receivers_clock() -> None:
    sky, bias = walker(toe=1e9), 1.4e5
    broadcast = Broadcast({f"G{i + 1:02}": Ephemeris(*(field[i : i + 1] for field in sky)) for i in range(36)})
    broadcast = replace(broadcast, klobuchar=np.full(8, 1e-8))
    receiver, axes = geodesy.geodetic_to_ecef(*MUNICH, 500.0), geodesy.enu_axes(*MUNICH)
    sky = sky._replace(af0=np.full(36, 1e-4))
    broadcast = replace(broadcast, kepler={n: e._replace(af0=np.array([1e-4])) for n, e in broadcast.kepler.items()})
    arrived = 1e9 + np.arange(5.0)[:, None]
    flight = np.full((5, 36), 0.075)
    for _ in range(5):
        way = sight.distance(receiver, kepler.position(sky, arrived - flight))
        flight = way / C
    elevation, azimuth = sight.elevation_azimuth(receiver, kepler.position(sky, arrived - flight), axes)
    air = atmosphere.saastamoinen(MUNICH[0], 500.0, elevation)
    air = air + atmosphere.klobuchar(np.full(8, 1e-8), *MUNICH, elevation, azimuth, arrived % 604800)
    received = np.where(elevation > np.deg2rad(10), way + bias - C * kepler.clock(sky, arrived) + air, np.nan)
    # the receiver's clock is ahead, and so are its times
    seen = Observed(arrived[:, 0] + bias / C, tuple(broadcast.satellites), {"pseudorange_m": received})
    found = with_satellites(seen, broadcast).value
    left = found["corrected_m"] - way - bias
    assert np.isfinite(left).sum() == np.isfinite(received).sum() > 30
    assert np.nanmax(np.abs(left)) < 0.02
    np.testing.assert_allclose(found["elevation_rad"], np.where(np.isfinite(received), elevation, np.nan), atol=1e-6)


def test_without_places_there_are_no_satellites(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no raw satellite data with orbits of G"):
        satellites(read(SMALL["u-blox"](tmp_path)), "G")


def test_a_foreign_ephemeris_is_left_out(tmp_path: Path) -> None:
    path = SMALL["RINEX navigation"](tmp_path)
    sound = read_nav(path)
    assert len(sound.kepler["G07"].toe) == 3
    lines = path.read_text().splitlines(keepends=True)
    second = next(i for i, line in enumerate(lines) if line.startswith("G07 2025 08 24 14"))
    lines[second + 1] = lines[second + 1][:61] + f"{0.123:19.12e}\n"  # another place on the orbit
    path.write_text("".join(lines))
    result = read_nav(path)
    assert result.odd == ("G07",)
    assert len(result.kepler["G07"].toe) == 2


def test_the_ionosphere_of_subframe_four() -> None:
    result = (3, -2, 5, -7, 11, -13, 17, -19)
    bits = "10001011" + "0" * 34 + "0" * 1 + "100" + "00" + "01" + f"{56:06b}"
    bits += "".join(f"{one & 255:08b}" for one in result)
    bits = bits.ljust(240, "0")
    words = tuple(int(bits[24 * i : 24 * i + 24], 2) << 6 for i in range(10))
    gather = Subframes("G")
    assert gather.take(words, 0.0) is None
    scales = 2.0 ** np.array([-30, -27, -24, -24, 11, 14, 16, 16])
    np.testing.assert_array_equal(gather.klobuchar(), np.array(result) * scales)


def test_several_seen_at_once_are_columns_of_their_own(tmp_path: Path) -> None:
    log = read(SMALL["UTIAS measurements"](tmp_path))
    assert [channel.path for channel in log.channels] == [
        f"barcode_{one}.{what}" for one in (14, 90) for what in ("range", "bearing")
    ]
    np.testing.assert_allclose(column(log, "barcode_90.range"), 3 + 0.1 * np.arange(EPOCHS))


def test_a_packed_file_is_read_up_to_its_damage(tmp_path: Path) -> None:
    rows = "".join(f"{k / 100},{k % 7}.5,{k % 11}.25\n" for k in range(20_000))
    path = tmp_path / "drive.csv.gz"
    packed = gzip.compress(("time,ax,ay\n" + rows).encode(), mtime=0)
    path.write_bytes(packed)
    assert len(read(path)) == 20_000
    path.write_bytes(packed[: len(packed) // 2])
    log = read(path)
    assert 1_000 < len(log) < 20_000
    (said,) = log.damage
    assert said.startswith("drive.csv.gz: the packed file is damaged or breaks off at unpacked byte")
    short = gzip.compress(("time,ax,ay\n" + rows[:30_000]).encode(), mtime=0)
    at = len(short) * 3 // 4
    path.write_bytes(short[:at] + b"\xff" * 50 + short[at + 50 :])
    unpacked = read_unpacked(
        path, lambda file: {file.read_text(errors="replace"): read_csv(SMALL["text table"](tmp_path))}
    )
    (content,) = unpacked
    assert content[:15_000] == ("time,ax,ay\n" + rows)[:15_000]
    path.write_bytes(b"no gzip at all")
    with pytest.raises(LogError, match="this file cannot be unpacked"):
        read(path)


def test_a_year_as_damage_makes_it_is_no_date() -> None:
    with pytest.raises(ValueError, match="no year"):
        calendar_s(["99999999999999999999", "1", "1", "0", "0", "0"])
