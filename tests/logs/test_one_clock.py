from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, VehicleFile, read

VEHICLE = """
[file.imu]
path = "imu.csv"
time = "t"
[file.gnss]
path = "gnss.csv"
time = "t"
offset_s = {offset}
[sensor.gnss]
file = "gnss"
[sensor.gnss.channel]
v = {{ column = "v", unit = "km/h" }}
[sensor.imu]
file = "imu"
[sensor.imu.channel]
a = {{ column = "a", unit = "g" }}
"""


def put(folder: Path, name: str, column: str, time: np.ndarray, value: np.ndarray) -> None:
    rows = "".join(f"{t!r},{v!r}\n" for t, v in zip(time.tolist(), value.tolist(), strict=True))
    (folder / name).write_text(f"t,{column}\n{rows}")


def drive(folder: Path, imu: np.ndarray, gnss: np.ndarray, offset: float = 0.0, resample: str = "hold") -> Log:
    put(folder, "imu.csv", "a", imu, np.sin(imu))
    put(folder, "gnss.csv", "v", gnss, 36 + gnss)
    return read(folder, VehicleFile.parse(VEHICLE.format(offset=offset)), resample)  # type: ignore[arg-type]


@pytest.mark.parametrize("offset", [0.0, -0.125, 0.3])
def test_nothing_arrives_before_its_time_and_everything_on_the_next_tick(tmp_path: Path, offset: float) -> None:
    random = np.random.default_rng(5)
    imu = 100 + np.cumsum(random.uniform(0.008, 0.012, 3000))
    gnss = 101 + np.cumsum(random.uniform(0.2, 0.3, 90))
    log = drive(tmp_path, imu, gnss, offset)
    assert [channel.path for channel in log.channels] == ["gnss.v", "imu.a"]
    np.testing.assert_allclose(log.time, imu - imu[0], atol=1e-9)
    want = np.full(len(imu), np.nan)
    for time in gnss:  # a loop over measurements, the rule word by word
        after = [k for k in range(len(imu)) if imu[k] >= time + offset]
        if after:
            want[after[0]] = (36 + time) / 3.6
    np.testing.assert_allclose(log.value[:, 0], want, rtol=1e-12)
    np.testing.assert_array_equal(log.fresh[:, 0], np.isfinite(want))
    np.testing.assert_allclose(log.value[:, 1], np.sin(imu) * 9.80665, rtol=1e-12)
    assert log.fresh[:, 1].all()


def test_equal_times_meet_though_rounded_otherwise(tmp_path: Path) -> None:
    imu = np.round(np.arange(1000) * 0.01, 6)
    gnss = np.round(np.arange(40) * 0.25, 6) + 1e-9
    log = drive(tmp_path, imu, gnss)
    np.testing.assert_allclose(log.time[log.fresh[:, 0]], np.arange(40) * 0.25, atol=1e-6)


def test_of_two_measurements_on_one_tick_the_later_stays_and_it_is_said(tmp_path: Path) -> None:
    log = drive(tmp_path, np.arange(100) * 0.1, np.array([1.01, 2.01, 2.02, 2.03, 5.0, 8.0]))
    np.testing.assert_allclose(log.value[log.fresh[:, 0], 0] * 3.6 - 36, [1.01, 2.03, 5.0, 8.0])
    assert any("2 rows dropped: a later row has the same time step" in note for note in log.notes)


def test_measurements_outside_the_ticks_are_left_out_and_said(tmp_path: Path) -> None:
    log = drive(tmp_path, 10 + np.arange(100) * 0.1, np.arange(60) * 0.5)
    times = log.time[log.fresh[:, 0]]
    np.testing.assert_allclose(times, np.arange(0, 10, 0.5), atol=1e-9)
    assert any("40 rows before the first or after the last row of imu.csv" in note for note in log.notes)


def test_while_the_fastest_is_silent_the_clock_goes_on(tmp_path: Path) -> None:
    imu = np.arange(1000) * 0.01
    log = drive(tmp_path, imu[(imu < 3) | (imu >= 6)], np.arange(40) * 0.25)
    assert np.diff(log.time).max() < 0.015
    silent = (log.time > 3) & (log.time < 5.98)
    assert np.isnan(log.value[silent, 1]).all()
    assert log.fresh[silent, 0].sum() == 11
    assert not log.fresh[silent, 1].any()


def test_linear_only_where_it_is_asked_for_and_not_across_gaps(tmp_path: Path) -> None:
    gnss = np.delete(np.arange(40) * 0.25, slice(12, 20))
    log = drive(tmp_path, np.arange(1000) * 0.01, gnss, resample="linear")
    inside = (log.time <= gnss[11]) | ((log.time >= gnss[12]) & (log.time <= gnss[-1]))
    np.testing.assert_allclose(log.value[inside, 0] * 3.6, 36 + log.time[inside], rtol=1e-9)
    assert np.isnan(log.value[~inside, 0]).all()
    np.testing.assert_array_equal(log.fresh[:, 0], inside)


def test_files_by_name_in_any_order(tmp_path: Path) -> None:
    folder = drive(tmp_path, np.arange(100) * 0.1, np.arange(10) * 1.0)
    vehicle = VehicleFile.parse(VEHICLE.format(offset=0.0))
    files = read([tmp_path / "gnss.csv", tmp_path / "imu.csv"], vehicle)
    np.testing.assert_array_equal(folder.value, files.value)
    assert folder.sensors == files.sensors
    assert [sensor.period_s for sensor in files.sensors] == pytest.approx([1.0, 0.1])


TWO = """
[file.imu]
path = "imu.csv"
time = "t"
[file.gnss]
path = "gnss.csv"
time = "t"
[sensor.other]
file = "gnss"
[sensor.other.channel]
v = {{ column = "v", kind = "{kind}" }}
[sensor.imu]
file = "imu"
[sensor.imu.channel]
a = {{ column = "a", unit = "g" }}
"""


def two(folder: Path, kind: str, imu: np.ndarray, other: np.ndarray) -> Log:
    put(folder, "imu.csv", "a", imu, np.sin(imu))
    put(folder, "gnss.csv", "v", other, 36 + other)
    return read(folder, VehicleFile.parse(TWO.format(kind=kind)))


@pytest.mark.parametrize(
    ("kind", "hz", "ticks"), [("estimate", 105, 1000), ("estimate", 200, 2000), ("context", 200, 1000)]
)
def test_ticks_are_those_of_a_sensor(tmp_path: Path, kind: str, hz: int, ticks: int) -> None:
    """An estimate a little faster than the sensors, or anything that is no measurement, must not cost their rows."""
    log = two(tmp_path, kind, np.arange(1000) / 100, np.arange(10 * hz) / hz)
    assert len(log) == ticks
    assert log.fresh[:, log.index("imu.a")].sum() == 1000


def test_a_state_from_before_the_first_row_holds_at_it(tmp_path: Path) -> None:
    times = np.array([1.0, 2.0, 3.0, 13.0])
    log = two(tmp_path, "context", 10 + np.arange(1000) / 100, times)
    state = log.index("other.v")
    assert log.value[0, state] == 39  # of 3 s
    assert log.time[log.fresh[:, state]].tolist() == [0.0, 3.0]
    assert not any("left out" in note for note in log.notes)
    measured = two(tmp_path, "", 10 + np.arange(1000) / 100, times)
    assert any("left out" in note for note in measured.notes)
