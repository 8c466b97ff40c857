"""Ephemerides of BeiDou and GLONASS out of bits that an encoder of the tests' own has laid."""

from pathlib import Path

import numpy as np
import pytest

from logs.written_subframes import beidou, glonass, orbit, rover, strings
from sensorfault.logs import read
from sensorfault.logs.readers.gnss.beidou import BeidouSubframes
from sensorfault.logs.readers.gnss.glonass import GlonassStrings
from sensorfault.logs.readers.gnss.rinex_nav import read_nav
from sensorfault.numerics.gnss import kepler
from sensorfault.numerics.gnss.glonass import GlonassEphemeris
from sensorfault.numerics.gnss.kepler import Ephemeris

SECOND, GPS_S = 259_206, 2381 * 604_800.0 + 259_220  # of BeiDou's week, and GPS time
HALF = np.pi / 2**31
POTSDAM = Path("gnss") / "smartloc_berlin_potsdamer_platz"
UNITS = {  # BDS-SIS-ICD-B1I, tables 5-6 and 5-8
    "group_delay": 1e-10, "af0": 2.0**-33, "af1": 2.0**-50, "af2": 2.0**-66, "delta_n": np.pi / 2**43,
    "anomaly": HALF, "eccentricity": 2.0**-33, "sqrt_a": 2.0**-19, "inclination": HALF, "node": HALF, "perigee": HALF,
    "node_rate": np.pi / 2**43, "inclination_rate": np.pi / 2**43, "cuc": 2.0**-31, "cus": 2.0**-31, "crc": 2.0**-6,
    "crs": 2.0**-6, "cic": 2.0**-31, "cis": 2.0**-31, "toe_of_week": 8.0,
}  # fmt: skip


@pytest.mark.parametrize("paged", [False, True])
def test_beidou_says_what_was_encoded(paged: bool) -> None:
    numbers = orbit()
    gather = BeidouSubframes(paged)
    *before, found = [gather.take(words, GPS_S) for words in beidou(numbers, SECOND, paged)]
    assert before == [None] * len(before)
    assert isinstance(found, Ephemeris)
    for name, unit in UNITS.items():
        assert getattr(found, name) == pytest.approx(numbers[name] * unit, rel=1e-15), name
    assert found.toe == found.toc == GPS_S - 6  # fourteen seconds later than by BeiDou's clock
    assert np.rad2deg(found.tilt) == (-5.0 if paged else 0.0)


@pytest.mark.parametrize("paged", [False, True])
def test_of_two_turns_no_ephemeris_of_beidou_is_made(paged: bool) -> None:
    gather = BeidouSubframes(paged)
    first = beidou(orbit(), SECOND, paged)
    second = beidou(orbit(), SECOND + 30, paged)
    assert not any(gather.take(words, GPS_S) for words in (*first[:-1], second[-1]))
    assert not any(gather.take(words, GPS_S) for words in beidou(orbit() | {"health": 1}, SECOND, paged))
    assert gather.take((0x38901637,), GPS_S) is None


def test_glonass_says_what_was_encoded() -> None:
    numbers = strings()
    gather = GlonassStrings()
    *before, found = [gather.take(words, GPS_S) for words in glonass(numbers, 7)]
    assert before == [None] * 3
    assert isinstance(found, GlonassEphemeris)
    assert found.offset == 1_000_000 * 2.0**-30
    assert found.drift == -700 * 2.0**-40
    for ours, theirs, unit in (
        (found.start, "{}", 2.0**-11),
        (found.speed, "v{}", 2.0**-20),
        (found.pull, "a{}", 2.0**-30),
    ):
        np.testing.assert_allclose(ours, [1e3 * numbers[theirs.format(axis)] * unit for axis in "xyz"], rtol=1e-15)
    # 12:15 of Moscow is 9:15 UTC, and GPS time eighteen seconds ahead; the day is that which GPS_S is of
    assert found.toe == 2381 * 604_800 + 3 * 86_400 + 9.25 * 3600 + 18


@pytest.mark.parametrize("ill", [{"ill": 1}, {"silent": 1}])
def test_an_ill_satellite_or_one_of_two_frames_gives_no_state(ill: dict[str, int]) -> None:
    gather = GlonassStrings()
    assert not any(gather.take(words, GPS_S) for words in glonass(strings() | ill, 7))
    torn = [
        *glonass(strings(), 7)[:3],
        glonass(strings(), 8)[3],
    ]
    assert not any(gather.take(words, GPS_S) for words in torn)


def test_satellites_of_a_receivers_log_have_their_places(tmp_path: Path) -> None:
    path = rover(tmp_path / "rover.ubx")
    log = read(path)
    place, speed = (
        np.stack([log.value[:, log.index(f"R05.{name}")] for name in names], axis=1)
        for names in (("x_m", "y_m", "z_m"), ("vx_m_s", "vy_m_s", "vz_m_s"))
    )
    numbers = strings()
    start = 1e3 * np.array([numbers[axis] for axis in "xyz"]) / 2**11
    moved = start - speed[5] * 2.1e7 / 299_792_458  # on the way
    np.testing.assert_allclose(place[5], moved, atol=5.0)
    np.testing.assert_allclose(log.value[5, log.index("R05.clock_s")], 1_000_000 / 2**30, atol=1e-9)
    place = np.array([log.value[5, log.index(f"C20.{axis}_m")] for axis in "xyz"])
    assert np.linalg.norm(place) == pytest.approx(5282.6**2, rel=0.002)


@pytest.mark.real
def test_what_beidou_really_sent_comes_through(real_data: Path) -> None:
    result = read_nav(real_data / POTSDAM / "BRDC00WRD_U_20161580000_01D_MN.rnx")
    names = [name for name in result.kepler if name[0] == "C"]
    assert {"C01", "C05", "C11"} <= set(names)
    for name in names:
        for row in range(len(result.kepler[name].toe)):
            sent = Ephemeris(*(float(field[row]) for field in result.kepler[name]))
            exact = {field: getattr(sent, field) / unit for field, unit in UNITS.items()}
            numbers = {field: round(value) for field, value in exact.items()}
            # the file's numbers are whole ones of these units, to the twelve digits that it has
            assert all(abs(numbers[field] - exact[field]) < 1e-3 + 1e-11 * abs(exact[field]) for field in UNITS), name
            numbers |= {"toc": numbers["toe_of_week"], "health": 0}
            paged = sent.tilt != 0
            gather = BeidouSubframes(paged)
            *_, found = [gather.take(words, sent.toe) for words in beidou(numbers, int(sent.toe_of_week), paged)]
            assert found is not None
            times = sent.toe + np.array([-1800.0, 1800.0])
            np.testing.assert_allclose(kepler.position(found, times), kepler.position(sent, times), atol=0.02)
            np.testing.assert_allclose(kepler.clock(found, times), kepler.clock(sent, times), atol=1e-12)


@pytest.mark.real
def test_what_glonass_really_sent_comes_through(real_data: Path) -> None:
    result = read_nav(real_data / POTSDAM / "brdc1580.16g")
    assert len(result.glonass) > 20
    for name, each in result.glonass.items():
        for row in range(len(each.toe)):
            toe, offset, drift, place, speed, pull = (field[row] for field in each)
            exact = {
                f"{of}{axis}": value / 1e3 * 2.0**power
                for of, power, vector in (("", 11, place), ("v", 20, speed), ("a", 30, pull))
                for axis, value in zip("xyz", vector, strict=True)
            }
            exact |= {"offset": -offset * 2.0**30, "drift": drift * 2.0**40}
            numbers = {field: round(value) for field, value in exact.items()}
            assert all(abs(numbers[field] - exact[field]) < 1e-3 for field in exact), name
            moscow = (toe - 17 + 10_800) % 86_400
            numbers |= {"ill": 0, "silent": 0, "quarter": round(moscow / 900)}
            gather = GlonassStrings()
            *_, found = [gather.take(words, toe - 600) for words in glonass(numbers, row)]
            assert found is not None
            assert found.toe == toe
            for ours, theirs in ((found.start, place), (found.speed, speed), (found.pull, pull)):
                np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)
            np.testing.assert_allclose((found.offset, found.drift), (offset, drift), rtol=1e-9, atol=1e-18)
