from dataclasses import replace

import numpy as np
import pytest

from sensorfault.logs import Channel, Log, LogError, Sensor
from sensorfault.logs.units import UNITS, from_si, known, si_unit, spelled, to_si


def log() -> Log:
    value = np.array([[0.1, 10, 1], [0.2, 10, np.nan], [0.3, 20, 3], [0.4, 20, 4]])
    return Log(
        np.array([0.0, 0.5, 1.0, 2.0]),
        value,
        np.isfinite(value),
        (Channel("x", "gyro", "deg/s"), Channel("speed", "gnss", "km/h"), Channel("x", "magnetometer", "uT")),
        (Sensor("gyro", 0.5), Sensor("gnss", 1.0, held=True), Sensor("magnetometer", 0.5)),
    )


def test_columns_by_name() -> None:
    assert log().index("gyro.x") == 0
    assert log().index("speed") == 1
    assert log().of("magnetometer") == (2,)
    with pytest.raises(LogError, match=r"more than one channel is called 'x'; take one of gyro.x"):
        log().index("x")
    with pytest.raises(LogError, match="no channel is called 'z'"):
        log().index("z")
    with pytest.raises(LogError, match="no sensor is called 'lidar'; take one of gyro, gnss, magnetometer"):
        log().of("lidar")


def test_how_often_a_channel_has_a_new_value_and_whether_it_changes() -> None:
    some = log()
    still = replace(some, value=np.where(np.isnan(some.value), np.nan, 7.0), fresh=some.fresh & (some.value != 10))
    np.testing.assert_array_equal(some.measured, [1.0, 1.0, 0.75])
    np.testing.assert_array_equal(still.measured, [1.0, 0.5, 0.75])
    assert some.changes.all()
    assert not still.changes.any()


def test_a_span_and_a_choice() -> None:
    middle = log().between(0.5, 2.0)
    np.testing.assert_array_equal(middle.time, [0.5, 1.0])
    assert middle.duration_s == 0.5
    chosen = middle.select(["magnetometer.x", "gyro.x"])
    np.testing.assert_array_equal(chosen.value, [[np.nan, 0.2], [3, 0.3]])
    assert [sensor.name for sensor in chosen.sensors] == ["gyro", "magnetometer"]


def test_a_table_for_people() -> None:
    frame = log().frame()
    assert frame.columns == ["time_s", "gyro.x", "gnss.speed", "magnetometer.x"]
    np.testing.assert_allclose(frame["gyro.x"], np.degrees([0.1, 0.2, 0.3, 0.4]))
    np.testing.assert_allclose(frame["gnss.speed"], [36, 36, 72, 72])
    assert frame["magnetometer.x"].null_count() == 1


def test_shapes_that_do_not_go_together() -> None:
    with pytest.raises(LogError, match="do not fit"):
        Log(np.zeros(2), np.zeros((2, 1)), np.ones((2, 1), bool), (), (Sensor("gyro", 1.0),))


@pytest.mark.parametrize(
    ("value", "unit", "si", "si_name"),
    [
        (180.0, "deg", np.pi, "rad"),
        (450_000_000.0, "1e-7deg", np.pi / 4, "rad"),
        (36.0, "km/h", 10.0, "m/s"),
        (1.0, "kn", 0.514444444, "m/s"),
        (2.0, "g", 19.6133, "m/s^2"),
        (1013.25, "hPa", 101325.0, "Pa"),
        (60.0, "rpm", 2 * np.pi, "rad/s"),
        (1.0, "gauss", 1e-4, "T"),
        (20.0, "degC", 20.0, "degC"),
        (3.0, "parsec", 3.0, "parsec"),
    ],
)
def test_units(value: float, unit: str, si: float, si_name: str) -> None:
    assert to_si(value, unit) == pytest.approx(si)
    assert from_si(si, unit) == pytest.approx(value)
    assert si_unit(unit) == si_name


def test_spellings() -> None:
    assert spelled("m/s²") == "m/s^2"
    assert known("kph")
    assert not known("parsec")
    assert all(si_unit(si) == si for si, _ in UNITS.values())
