"""Facts of the real logs of raw satellite navigation, and of ranges between robots."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_source
from sensorfault.logs.readers.gnss.rinex_nav import read_nav
from sensorfault.logs.readers.gnss.sp3 import read_orbits
from sensorfault.logs.satellites import satellites
from sensorfault.numerics.geodesy import geodetic_to_ecef
from sensorfault.numerics.gnss import sight

pytestmark = pytest.mark.real

C = 299792458.0
POTSDAM = Path("gnss") / "smartloc_berlin_potsdamer_platz"
WALK = Path("gnss") / "f9p_walk0827" / "gnss_1730.ubx"


def column(log: Log, path: str) -> np.ndarray:
    return log.value[:, log.index(path)]


def facts(log: Log, rows: int, duration_s: float, period_s: float) -> None:
    assert len(log) == rows
    assert log.duration_s == pytest.approx(duration_s, abs=0.05)
    assert log.period_s == pytest.approx(period_s, rel=0.02)
    assert (np.diff(log.time) > 0).all()
    assert not (log.fresh & ~np.isfinite(log.value)).any()


def truth(file: Path) -> np.ndarray:
    """Rows of time [s] and ECEF [m], without any of the package's readers."""
    return np.loadtxt(file, usecols=(1, 2, 3, 4))


def residuals(log: Log, place: np.ndarray, system: str, turn: bool = True) -> np.ndarray:
    """What is left of the corrected ranges beside truth, less the median of each tick (the receiver's clock) [m]."""
    sky = satellites(log, system)
    way = (
        sight.distance(place[:, None], sky.position) if turn else np.linalg.norm(sky.position - place[:, None], axis=2)
    )
    left = sky.corrected - way
    left = left[np.isfinite(left).sum(axis=1) > 1]
    return np.abs(left - np.nanmedian(left, axis=1, keepdims=True))


def test_libRSF_ranges_agree_with_truth_once_the_earth_turns(real_data: Path) -> None:
    folder = real_data / POTSDAM
    log, place = read(folder / "Berlin_Potsdamer_Platz_Input.txt"), read(folder / "Berlin_Potsdamer_Platz_GT.txt")
    facts(log, 1372, 282.80, 0.2)
    assert column(log, "odometry.x")[[0, -1]] == pytest.approx([5.85, 5.0916667])
    assert column(log, "G12.corrected_m")[0] == pytest.approx(19949087.65382)
    assert len([sensor for sensor in log.sensors if sensor.name[0] == "G"]) == 12
    np.testing.assert_allclose(place.value, truth(folder / "Berlin_Potsdamer_Platz_GT.txt")[:, 1:])
    assert np.nanmedian(residuals(log, place.value, "G", turn=False)) == pytest.approx(15.3, abs=0.5)
    assert np.nanmedian(residuals(log, place.value, "G")) <= 8.0


def test_libRSF_with_the_reference_receiver(real_data: Path) -> None:
    folder = real_data / POTSDAM
    log, place = (read(folder / f"Berlin_Potsdamer_Platz_RTK_{what}.txt") for what in ("Input", "GT"))
    lines = [line.split() for line in (folder / "Berlin_Potsdamer_Platz_RTK_Input.txt").read_text().splitlines()]
    at = [float(line[1]) for line in lines]
    facts(log, len({*at}), max(at) - min(at), 0.2)
    np.testing.assert_allclose(place.value, truth(folder / "Berlin_Potsdamer_Platz_RTK_GT.txt")[:, 1:])


def test_rinex_2_ranges_agree_with_truth_by_the_broadcast_orbits(real_data: Path) -> None:
    folder = real_data / POTSDAM
    log = read(folder / "Berlin_Potsdamer_Platz.obs")
    facts(log, 1375, 283.40, 0.2)
    assert log.epoch_s == pytest.approx(1465211441.7 - 17, abs=1e-3)  # 2016-06-06 11:10:41.7 of GPS time
    assert column(log, "G12.pseudorange_m")[0] == 19834589.652
    assert column(log, "G12.doppler_hz")[0] == 221.941
    assert column(log, "R21.pseudorange_m")[0] == 22683692.244
    assert column(log, "S20.pseudorange_m")[0] == 39064556.539
    assert any("contradict the others" in note for note in log.notes)
    at = truth(folder / "Berlin_Potsdamer_Platz_GT.txt")
    tick = np.abs(log.time - at[:, :1]).argmin(axis=1)
    place = np.full((len(log), 3), np.nan)
    place[tick] = at[:, 1:]
    assert np.nanmedian(residuals(log, place, "G")) <= 8.0
    assert np.nanmedian(residuals(log, place, "R")) <= 15.0


def test_broadcast_orbits_are_metres_from_the_precise(real_data: Path) -> None:
    precise = read_orbits(real_data / POTSDAM / "gbm19001.sp3")
    assert len(precise.time) == 288
    assert precise.position[0, precise.satellites.index("C01"), 0] == -32309946.649
    for file, system, usual_m, most_m in (
        ("brdc1580.16n", "G", 1.6, 5.0),
        ("brdc1580.16g", "R", 3.0, 10.5),
        ("BRDC00WRD_U_20161580000_01D_MN.rnx", "E", 1.2, 15.0),
        ("BRDC00WRD_U_20161580000_01D_MN.rnx", "C", 5.0, 10.0),  # five geostationary
    ):
        result = read_nav(real_data / POTSDAM / file)
        names = [name for name in result.satellites if name in precise.satellites and name[0] == system]
        away, clocks = [], []
        for name in names:
            i = precise.satellites.index(name)
            found = result.at(name, precise.time)
            away.append(np.linalg.norm(found.position - precise.position[:, i], axis=1))
            relativity = -2 * (found.position * found.velocity).sum(axis=1) / C**2
            clocks.append(C * (found.clock - relativity - precise.clock[:, i]))
        assert len(names) >= 9
        assert np.nanmedian(away) < usual_m
        assert np.nanmax(away) < most_m
        assert np.nanmedian(np.nanstd(clocks, axis=1)) < 2.0


def test_satellites_are_where_the_sp3_and_the_navigation_file_say(real_data: Path) -> None:
    orbits = read(real_data / POTSDAM / "gbm19001.sp3")
    facts(orbits, 288, 86100.0, 300.0)
    assert column(orbits, "G01.clock_s")[0] == pytest.approx(22.70e-6, abs=1e-7)
    places = read(real_data / POTSDAM / "brdc1580.16n")
    facts(places, 288, 86100.0, 300.0)
    assert column(places, "G01.x_m")[0] == pytest.approx(column(orbits, "G01.x_m")[0], abs=5.0)


def test_a_walk_gives_536_raw_epochs(real_data: Path) -> None:
    log = read(real_data / WALK)
    facts(log, 536, 133.75, 0.25)
    raw, fixes = read_source(real_data / WALK, "RXM-RAWX").frame, read_source(real_data / WALK, "NAV-PVT").frame
    assert len(raw) == len(fixes) == 536
    # GPS week 2381, 408639.748 s, 18 leap seconds
    assert raw["time"][0] == pytest.approx(315964800 + 2381 * 604800 + 408639.748 - 18, abs=1e-3)
    assert fixes["latitude"][0] == pytest.approx(40.0966916)
    assert fixes["altitude"][0] == pytest.approx(1580.048)
    walked = [np.deg2rad(fixes[name].to_numpy()) for name in ("latitude", "longitude")]
    receiver = geodetic_to_ecef(*walked, fixes["altitude"].to_numpy())
    assert np.nanmedian(residuals(log, receiver, "G")) < 6.0
    assert np.nanmedian(residuals(log, receiver, "E")) < 5.0
    # BeiDou on B3I, by the seven D1 messages that are whole; B1I is not in the log
    assert np.nanmedian(residuals(log, receiver, "C")) < 6.0
    assert len(satellites(log, "C").names) == 7
    born = satellites(log).born
    assert born.any(axis=0).all()


def test_rinex_3_at_rest(real_data: Path) -> None:
    log = read(real_data / "gnss" / "instinct_tckf_static" / "reach-m2-01_raw_202306291111.23O")
    facts(log, 610, 60.90, 0.1)
    assert column(log, "G01.pseudorange_m")[0] == 21487708.882
    assert column(log, "C36.doppler_hz")[0] == -3299.245
    assert column(log, "E33.cn0_dbhz")[0] == 42
    receiver = np.array([4157198.3767, 671195.0626, 4774772.0490])  # APPROX POSITION XYZ
    for system in "GEC":
        assert np.nanmedian(residuals(log, np.tile(receiver, (610, 1)), system)) < 4.0


def test_labels_of_smartloc(real_data: Path) -> None:
    log = read(real_data / POTSDAM / "RXM-RAWX.csv")
    facts(log, 285, 60.0, 0.2)
    assert column(log, "G12.pseudorange_m")[0] == 19834597.8712713
    assert np.rad2deg(column(log, "gnss.latitude")[0]) == pytest.approx(52.504560220676)
    blind = np.concatenate([column(log, f"{s.name}.nlos") for s in log.sensors if s.name[0] == "G"])
    assert (blind == 1).sum() == 1373
    assert (blind == 0).sum() == 953


@pytest.mark.parametrize(
    ("name", "rows", "duration_s", "first", "last"),
    [
        ("Robot1_Odometry", 61785, 887.947, {"speed.speed": 0.086}, {"speed.speed": 0.0}),
        ("Robot1_Groundtruth", 49241, 771.873, {"local_position.x": 1.4127729}, {"local_position.x": 3.7738052}),
        (
            "Robot1_Measurement",
            1234,
            737.567,
            {"barcode_14.range": 3.787, "barcode_90.bearing": -0.005},
            {"barcode_9.range": 1.11},
        ),
    ],
)
def test_packed_tables_of_robots(
    real_data: Path, name: str, rows: int, duration_s: float, first: dict[str, float], last: dict[str, float]
) -> None:
    log = read(real_data / "ranging" / "mrclam" / "MRCLAM_Dataset6" / f"{name}.dat.gz")
    assert len(log) == rows
    assert log.duration_s == pytest.approx(duration_s, abs=1e-3)
    for path, value in first.items():
        assert column(log, path)[0] == pytest.approx(value)
    for path, value in last.items():
        assert column(log, path)[-1] == pytest.approx(value)


def test_every_robot_and_every_case_reads(real_data: Path) -> None:
    packed = sorted((real_data / "ranging" / "mrclam" / "MRCLAM_Dataset6").glob("Robot*.gz"))
    cases = sorted((real_data / "ranging" / "uwb_outdoor" / "LOS").glob("*/*"))
    assert (len(packed), len(cases)) == (15, 4)
    for path in packed:
        log = read(path)
        assert 600 < log.duration_s < 1000
    for path in cases:
        log = read(path)
        assert 150 < log.duration_s < 300
        assert {"a3_range", "a5_range", "a9_range", "a12_range"} <= {sensor.name for sensor in log.sensors}


def test_what_a_vehicle_file_of_satellites_says_is_enough(real_data: Path) -> None:
    vehicle = VehicleFile.parse(guess(real_data / WALK).to_toml())
    assert read(real_data / WALK, vehicle).channels == read(real_data / WALK).channels
