from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import VehicleFile, read
from sensorfault.logs.held import changes, fresh_rows, looks_held, repeats, usual_period_s

NAN = np.nan


def test_a_row_repeats_only_if_every_channel_does() -> None:
    value = np.array([[1, 1], [1, 2], [1, 2], [3, 2], [3, 2.0]])
    np.testing.assert_array_equal(repeats(value), [False, False, True, False, True])


def test_rows_without_a_value_neither_repeat_nor_part_repeats() -> None:
    value = np.array([[1, 1], [NAN, NAN], [1, 1], [1, NAN], [1, NAN]])
    np.testing.assert_array_equal(repeats(value), [False, False, True, False, True])


def test_an_epoch_column_marks_measurements_that_repeat_the_last() -> None:
    value = np.array([[5.0], [5], [5], [5], [7], [7]])
    epoch = np.array([NAN, 1, 1, 2, 3, 3])
    np.testing.assert_array_equal(fresh_rows(value, True, epoch)[:, 0], [False, True, False, True, True, False])
    np.testing.assert_array_equal(fresh_rows(value, True, None)[:, 0], [True, False, False, False, True, False])
    assert fresh_rows(value, False, None).all()


def test_changes_starts_with_one() -> None:
    np.testing.assert_array_equal(changes(np.array([4.0, 4, 5, NAN, 5])), [True, False, True, False, True])


def held_signal(rate: float, rows: int, random: np.random.Generator) -> np.ndarray:
    """Measurements at `rate` per row, each repeated until the next."""
    at = np.floor(np.arange(rows) * rate).astype(int)
    return random.normal(size=(at[-1] + 1, 2))[at]


@pytest.mark.parametrize("rate", [0.6, 0.5, 0.4, 0.2, 0.196, 0.02])
def test_holds_of_every_length_are_recognised(rate: float) -> None:
    value = held_signal(rate, 4000, np.random.default_rng(1))
    assert looks_held(value)
    parked = value.copy()
    parked[500:3000] = parked[499]
    assert looks_held(parked)


def test_what_only_repeats_now_and_then_is_no_hold() -> None:
    random = np.random.default_rng(2)
    noise = random.normal(size=(4000, 3))
    coarse = np.round(random.normal(size=(4000, 1)) * 0.5)  # repeats half its rows, for one row or for six
    slow = np.cumsum(random.random((4000, 1)) < 0.2, axis=0).astype(float)  # changes by chance, one row in five
    still = noise.copy()
    still[:3000] = 0.0  # an airspeed on the ground
    for value in (noise, coarse, slow, still, np.zeros((100, 1))):
        assert not looks_held(value)


def test_a_standstill_does_not_move_the_period() -> None:
    time = np.arange(3000) * 0.02
    fresh = np.zeros((3000, 1), bool)
    fresh[::5] = True
    fresh[500:2000] = False
    assert usual_period_s(time, fresh, 0.02) == pytest.approx(0.1)


def test_a_held_sensor_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    rows = [(k * 0.02, k * 0.37 % 1, 10 + k // 5, 100 + k // 5) for k in range(500)]
    rows[100:150] = [(t, a, 30, fix) for t, a, _, fix in rows[100:150]]  # ten fixes of one speed
    path.write_text("t,a,speed,fix\n" + "".join(f"{t},{a},{v},{fix}\n" for t, a, v, fix in rows))
    text = (
        '[file.log]\ntime = "t"\n[sensor.imu.channel]\na = { column = "a" }\n'
        '[sensor.gnss]\nheld = true\n#epoch\n[sensor.gnss.channel]\nspeed = { column = "speed", unit = "m/s" }\n'
    )
    blind = read(path, VehicleFile.parse(text))
    result = read(path, VehicleFile.parse(text.replace("#epoch", 'epoch = "fix"')))
    assert blind.fresh[:, 0].all()
    np.testing.assert_array_equal(np.flatnonzero(result.fresh[:, 1]), np.arange(0, 500, 5))
    missed = set(np.flatnonzero(result.fresh[:, 1])) - set(np.flatnonzero(blind.fresh[:, 1]))
    assert missed == set(range(105, 150, 5))
    for log in (blind, result):
        assert log.sensors[1].period_s == pytest.approx(0.1)
        assert log.sensors[1].held
        assert any("'gnss' is held" in note for note in log.notes)
        np.testing.assert_array_equal(log.value[:, 1], [row[2] for row in rows])


def test_a_hold_that_nobody_described_is_pointed_out(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("t,v\n" + "".join(f"{k / 50},{k // 5}\n" for k in range(500)))
    log = read(path, VehicleFile.parse('[file.log]\ntime = "t"\n[sensor.gnss.channel]\nv = { column = "v" }'))
    assert log.fresh.all()
    assert any("write held = true" in note for note in log.notes)


def test_a_sensor_that_speaks_now_and_then_holds_nothing() -> None:
    value = np.full((2000, 1), np.nan)
    value[::100, 0] = np.arange(20.0)
    assert not looks_held(value)
    assert looks_held(np.repeat(np.arange(20.0), 100)[:, None])
