"""Pauses of a recording, which all files share, against the dropouts of one."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sensorfault.logs import Log, VehicleFile, read
from sensorfault.logs.pauses import pauses_of, recorded, shared_pauses
from sensorfault.logs.summary import summarise

VEHICLE = """
[file.imu]
path = "imu.csv"
time = "t"
[file.baro]
path = "baro.csv"
time = "t"
[file.gnss]
path = "gnss.csv"
time = "t"
[sensor.imu]
file = "imu"
[sensor.imu.channel]
a = { column = "v", unit = "g" }
[sensor.baro]
file = "baro"
[sensor.baro.channel]
height = { column = "v", unit = "m" }
[sensor.gnss]
file = "gnss"
[sensor.gnss.channel]
speed = { column = "v", unit = "m/s" }
"""
IMU, BARO, GNSS = np.arange(2000) * 0.01, 0.003 + np.arange(200) * 0.1, 0.007 + np.arange(100) * 0.2


def outside(time: np.ndarray, *pauses: tuple[float, float]) -> np.ndarray:
    for start, end in pauses:
        time = time[(time <= start) | (time >= end)]
    return time


def flight(folder: Path, imu: np.ndarray, baro: np.ndarray, gnss: np.ndarray) -> Log:
    for name, time in (("imu", imu), ("baro", baro), ("gnss", gnss)):
        rows = "".join(f"{t!r},{float(np.sin(3 * t))!r}\n" for t in time.tolist())
        (folder / f"{name}.csv").write_text(f"t,v\n{rows}")
    return read(folder, VehicleFile.parse(VEHICLE))


def test_a_pause_has_no_ticks_and_is_said_once(tmp_path: Path) -> None:
    pauses = (5.0, 9.0), (12.0, 12.5)
    log = flight(tmp_path, *(outside(time, *pauses) for time in (IMU, BARO, GNSS)))
    lasts = log.pauses[:, 1] - log.pauses[:, 0]
    np.testing.assert_allclose(log.pauses[:, 0], [5.0, 12.0], atol=0.011)
    np.testing.assert_allclose(lasts, [4.0, 0.5], atol=0.011)
    assert np.isfinite(log.value[:, 0]).mean() > 0.99  # no tick is empty for having been put into a pause
    said = [note for note in log.notes if "gap" in note]
    assert len(said) == 1
    assert said[0].startswith("The recording has 2 gaps, 4.5 s in all, the longest 4 s at 5.000 s; nothing is judged")
    assert [sensor.gaps for sensor in summarise(log)] == [0, 0, 0]
    assert log.fresh[:, 1].sum() == len(outside(BARO, *pauses))  # no row was lost


def test_a_dropout_of_one_file_is_filled_and_said_of_it(tmp_path: Path) -> None:
    log = flight(tmp_path, outside(IMU, (5.0, 9.0)), BARO, GNSS)
    assert not len(log.pauses)
    silent = (log.time > 5.0) & (log.time < 8.99)
    assert silent.sum() == 398
    assert not log.fresh[silent, 0].any()
    assert [note for note in log.notes if "gap" in note] == [
        "imu.csv: 1 gap longer than 3 periods of 0.01 s, the longest 4 s at 5.000 s; left as gaps."
    ]


def test_a_dropout_that_ends_in_a_pause_is_both(tmp_path: Path) -> None:
    """The inertial unit is silent from 5 s on, the others until 7 s; at 9 s all are back."""
    log = flight(tmp_path, outside(IMU, (5.0, 9.0)), outside(BARO, (7.0, 9.0)), outside(GNSS, (7.0, 9.0)))
    ((start, end),) = log.pauses
    assert (start, end) == (pytest.approx(6.903, abs=0.11), pytest.approx(9.0, abs=0.011))
    silent = (log.time > 5.0) & (log.time < start)
    assert silent.sum() > 180
    assert not log.fresh[silent, 0].any()
    assert any(note.startswith("imu.csv: 1 gap") and "the longest 1.9" in note for note in log.notes)


def test_a_gap_in_which_only_one_was_due_is_its_own(tmp_path: Path) -> None:
    """The others would not have come in these 60 ms anyway, so nobody knows."""
    log = flight(tmp_path, outside(IMU, (5.01, 5.08)), BARO, GNSS)
    assert not len(log.pauses)
    assert np.isnan(log.value[(log.time > 5.015) & (log.time < 5.075), 0]).sum() == 6


def test_a_file_that_is_dead_is_not_due() -> None:
    fast, slow, dead = IMU, BARO, np.array([0.0, 0.1, 0.2])
    gone = outside(fast, (5.02, 5.08))
    assert not len(shared_pauses([gone, slow, dead], [0.01, 0.1, 0.1], 0.01))
    assert len(shared_pauses([outside(fast, (5.0, 6.0)), outside(slow, (5.0, 6.0)), dead], [0.01, 0.1, 0.1], 0.01)) == 1


def test_the_pause_of_a_single_table(tmp_path: Path) -> None:
    rows = "".join(f"{t:.2f},{np.sin(t)},{np.cos(3 * t)}\n" for t in outside(IMU, (3.0, 8.0)).tolist())
    (tmp_path / "drive.csv").write_text(f"t,gyro_x,gyro_y\n{rows}")
    log = read(tmp_path / "drive.csv")
    np.testing.assert_allclose(log.pauses, [[3.0, 8.0]])
    assert sum("The recording has 1 gap, 5 s in all" in note for note in log.notes) == 1
    np.testing.assert_allclose(log.between(2.0, 4.0).pauses, np.zeros((0, 2)))


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(0.1, 5.0), min_size=2, max_size=40))
def test_recorded_time_stands_still_in_a_pause(steps: list[float]) -> None:
    time = np.cumsum(steps)
    pauses = pauses_of(time, 0.4)
    step, left = np.diff(time), np.diff(recorded(time, pauses))
    np.testing.assert_allclose(left, np.where(step > 1.2, 0.0, step), atol=1e-9)
