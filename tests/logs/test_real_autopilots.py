"""Facts of real flights, some with faults: rates, durations, every device, what they say of themselves."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, read
from sensorfault.logs.summary import summarise

pytestmark = pytest.mark.real

IMU = ("gyro", "accelerometer")
ERLE = "incidents/erle_quad_"
LOGS = {  # seconds, and the rates of sensors [Hz]
    "incidents/px4_ace_gps_spoof": (136.3, {"gyro": 200, "accelerometer": 200, "gnss": 1, "barometer": 5,
                                            "magnetometer": 5, "attitude": 20, "gyro2": 2, "accelerometer2": 2,
                                            "magnetometer2_uncalibrated": 1, "battery": 3.3}),
    "incidents/navio_quad_compass_interference": (185.2, {"gyro": 25, "magnetometer": 10, "magnetometer2": 10,
                                                          "gnss": 5, "barometer": 10, "battery": 10, "battery2": 10}),
    ERLE + "gps_wild": (124.3, {"gyro": 50, "accelerometer": 50, "gnss": 5.5, "barometer": 10, "magnetometer": 10}),
    ERLE + "gps_dropouts": (112.0, {"gyro": 50, "accelerometer": 50, "gnss": 5.5, "barometer": 10}),
    ERLE + "baro_broken": (1231, {"gyro": 50, "accelerometer": 50, "barometer": 10, "magnetometer": 10}),
    ERLE + "accel_low": (57, {"gyro": 50, "accelerometer": 50, "barometer": 10, "magnetometer": 10}),
    ERLE + "accel_two_disagree": (180, {"gyro": 50, "gyro2": 50, "accelerometer2": 50, "gnss": 5, "barometer": 10}),
    "incidents/erle_rover_baro_spike": (36, {"gyro": 50, "accelerometer": 50, "barometer": 10}),
    "incidents/ardupilot_loganalyzer": (110, {"attitude": 10, "barometer": 10, "gnss": 5, "battery": 1}),
    "healthy/quad_erle_pxf_2014": (172.4, {"gyro": 50, "accelerometer": 50, "barometer": 10}),
    "healthy/quad_v413_goodprop": (96.3, {"gyro": 24.5, "gyro2": 24.5, "gyro3": 24.5, "accelerometer3": 24.5,
                                          "barometer": 9.8, "magnetometer": 9.8, "magnetometer2": 9.8, "gnss": 5}),
    "uav/copter_jd2014": (332.5, {"gyro": 50, "gyro2": 50, "gnss": 5, "barometer": 10, "attitude": 10, "battery": 1}),
}  # fmt: skip


def first(folder: Path) -> Path:
    return min(file for file in folder.iterdir() if file.suffix.lower() in (".bin", ".log", ".ulg"))


def news(log: Log, path: str) -> tuple[np.ndarray, np.ndarray]:
    i = log.index(path)
    return log.time[log.fresh[:, i]], log.value[log.fresh[:, i], i]


@pytest.mark.parametrize("name", LOGS)
def test_rate_and_duration_of_every_device(real_data: Path, name: str) -> None:
    seconds, rates = LOGS[name]
    log = read(first(real_data / name))
    assert log.duration_s == pytest.approx(seconds, abs=0.6)
    found = {sensor.name: sensor.rate_hz for sensor in summarise(log)}
    assert {sensor: found.get(sensor) for sensor in rates} == pytest.approx(rates, rel=0.04)


def test_a_spoofed_receiver_says_something_of_it(real_data: Path) -> None:
    log = read(first(real_data / "incidents" / "px4_ace_gps_spoof"))
    for quantity, before, after in (("satellites", 11, 5), ("speed_accuracy", 0.3, 4.2), ("noise", 101, 139)):
        time, value = news(log, f"gnss.{quantity}")
        assert np.median(value[time < 110]) == pytest.approx(before, abs=1)
        assert np.abs(value[time > 117] - after).min() < 0.6, quantity


def test_a_silent_receiver_says_that_it_has_no_fix(real_data: Path) -> None:
    log = read(real_data / "incidents" / "erle_quad_gps_dropouts" / "GPS_issues1.BIN")
    time, fix = news(log, "gnss.fix_type")
    assert fix[time > 80].max() < 2
    assert len(time[time > 80]) > 3
    assert news(log, "gnss.latitude")[0].max() == pytest.approx(76.5, abs=1)


def test_states_of_a_copter(real_data: Path) -> None:
    log = read(first(real_data / "healthy" / "quad_v413_goodprop"))
    time, armed = news(log, "armed.armed")
    assert armed.tolist() == [0]  # the log begins when the copter is armed
    assert time[0] > 80
    time, landed = news(log, "landed.landed")
    assert landed.tolist()[0] in (0, 1)
    assert 0 in landed
    assert time[-1] > 60
    assert np.isfinite(log.value[0, log.index("mode.mode")])
    _, throttle = news(log, "throttle.throttle")
    assert 0.2 < np.median(throttle) < 0.5
