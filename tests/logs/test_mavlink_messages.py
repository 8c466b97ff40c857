"""MAVLink's messages: every device, marks of missing values, a receiver without a fix, and what holds."""

import struct
from pathlib import Path

import numpy as np
import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sensorfault.logs import Log, VehicleFile, guess, read

START_US = 1_700_000_000 * 10**6
RANDOM = np.random.default_rng(8)


def tlog(seconds: int = 10) -> bytes:
    link, written = mav.MAVLink(None, 1, 1), b""

    def put(us: int, message: mav.MAVLink_message) -> bytes:
        return struct.pack(">Q", us) + bytes(message.pack(link))

    for k in range(10 * seconds):
        us, ms = START_US + 100_000 * k, 5000 + 100 * k

        def axes(*means: float) -> list[int]:
            return [round(one) for one in RANDOM.normal(means, 5)]

        messages = [
            mav.MAVLink_raw_imu_message(1000 * ms, *axes(0, 0, -1000, 100, 0, 0, 200, 0, 400)),
            mav.MAVLink_scaled_imu2_message(ms, *axes(0, 0, -1000, 200, 0, 0, 300, 0, 400)),
            mav.MAVLink_attitude_message(ms, 0.1, 0.01 * k, 1.0, 0, 0, 0),
            mav.MAVLink_scaled_pressure_message(ms, 950 + k / 10, 0.0, 2500),
            mav.MAVLink_scaled_pressure2_message(ms, 940 + k / 10, 0.0, 2500),
            mav.MAVLink_sys_status_message(0, 0, 0, 0, 12_000 + k, -1, 80, 0, 0, 0, 0, 0, 0),
            mav.MAVLink_vibration_message(1000 * ms, 9, 8, 7, k, 2 * k, 0),
        ]
        if k % 2 == 0:
            place, late = (481_000_000 + k, 110_000_000, 500_000), k >= 40
            messages += [
                mav.MAVLink_gps_raw_int_message(
                    1000 * ms, 3 if late else 1, *(place if late else (0, 0, 0)), 80, 65535, 130 if late else 65535,
                    9000 if late else 65535, 9 if late else 255,
                ),
                mav.MAVLink_gps2_raw_message(1000 * ms, 3, *place, 90, 90, 130, 9000, 12, 0, 0),
            ]  # fmt: skip
        if k % 10 == 0:
            messages += [
                mav.MAVLink_heartbeat_message(2, 3, 128 + 81 if k >= 50 else 81, 5, 4, 3),
                mav.MAVLink_extended_sys_state_message(0, 1 if k < 50 else 2),
            ]
        written += b"".join(put(us, message) for message in messages)
    return written


@pytest.fixture
def log(tmp_path: Path) -> Log:
    path = tmp_path / "flight.tlog"
    path.write_bytes(tlog())
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    return read(path)


def news(log: Log, path: str) -> np.ndarray:
    i = log.index(path)
    return log.value[log.fresh[:, i], i]


def test_every_device(log: Log) -> None:
    assert {sensor.name for sensor in log.measurements().sensors} == {
        "gyro", "gyro2", "accelerometer", "accelerometer2", "magnetometer", "magnetometer2", "barometer", "barometer2",
        "gnss", "gnss2", "attitude", "battery",
    }  # fmt: skip
    assert news(log, "gyro2.x").mean() == pytest.approx(0.2, abs=0.01)
    assert news(log, "barometer2.pressure")[0] == pytest.approx(94_000)
    assert news(log, "barometer.temperature")[0] == pytest.approx(25)
    assert news(log, "accelerometer2_health.clipping")[3] == 6


def test_marks_of_missing_values(log: Log) -> None:
    assert "battery.current" not in {channel.path for channel in log.channels}  # -1 all the time
    assert news(log, "battery.voltage")[0] == pytest.approx(12)
    assert len(news(log, "gnss.satellites")) == 30
    assert "gnss.vdop" not in {channel.path for channel in log.channels}
    assert set(news(log, "gnss.hdop")) == {0.8}


def test_a_receiver_is_there_before_its_first_fix(log: Log) -> None:
    assert len(news(log, "gnss.fix_type")) == 50
    assert len(news(log, "gnss.latitude")) == len(news(log, "gnss.speed")) == 30
    assert len(news(log, "gnss2.latitude")) == 50


def test_what_holds(log: Log) -> None:
    assert news(log, "armed.armed").tolist() == [0] * 5 + [1] * 5
    assert news(log, "landed.landed").tolist() == [1] * 5 + [0] * 5
    assert {c.kind for c in log.channels if c.sensor in ("armed", "landed", "mode")} == {"context"}


BURST = [us for step in range(5) for us in 3 * [400_000 - 100_000 * step]]


def late(content: bytes, delays_us: list[int]) -> bytes:
    """The same packets, each handed over later by one delay after the other."""
    said, at, k = bytearray(content), 0, 0
    while at < len(said):
        us = int.from_bytes(said[at : at + 8], "big") + delays_us[k % len(delays_us)]
        said[at : at + 8] = us.to_bytes(8, "big")
        at, k = at + 8 + 12 + said[at + 9], k + 1
    return bytes(said)


def attitudes(seconds: float, boot_ms: int = 5000, begin_us: int = START_US, rate: int = 10) -> bytes:
    """Attitude and IMU, and a position that was last measured at the beginning."""
    link, written = mav.MAVLink(None, 1, 1), b""
    for k in range(round(rate * seconds)):
        us, ms = begin_us + round(1e6 * k / rate), boot_ms + round(1e3 * k / rate)
        for message in (
            mav.MAVLink_attitude_message(ms, 0.1, 0.01 * k, 1.0, 0, 0, 0),
            mav.MAVLink_raw_imu_message(1000 * ms, 0, 0, -1000, k % 7, 0, 0, 200, 0, 400),
            mav.MAVLink_gps_raw_int_message(5_000_000, 3, 481_000_000, 110_000_000, 500_000, 80, 80, 1, 1, 9),
        ):
            written += struct.pack(">Q", us) + bytes(message.pack(link))
    return written


def opened(folder: Path, content: bytes) -> Log:
    (folder / "flight.tlog").write_bytes(content)
    return read(folder / "flight.tlog")


def test_packets_that_arrive_in_bursts_have_their_own_times(tmp_path: Path) -> None:
    log = opened(tmp_path, late(attitudes(20), BURST))
    assert len(log) == 200
    np.testing.assert_allclose(np.diff(log.time), 0.1, atol=1e-6)
    assert log.epoch_s == pytest.approx(START_US / 1e6, abs=1e-3)  # the quickest ties the clocks
    np.testing.assert_array_equal(news(log, "attitude.pitch"), np.float32(0.01 * np.arange(200)).astype(float))


def test_an_autopilot_that_starts_anew(tmp_path: Path) -> None:
    again = late(attitudes(20, boot_ms=300, begin_us=START_US + 25_000_000), BURST)
    log = opened(tmp_path, attitudes(20, boot_ms=100_000) + again)
    assert log.duration_s == pytest.approx(45.3, abs=0.01)  # nobody knows how late its first packet was
    time = log.time[log.fresh[:, log.index("attitude.roll")]]
    assert len(time) == 400
    np.testing.assert_allclose(np.diff(time[200:]), 0.1, atol=1e-6)


def test_a_message_that_repeats_an_old_measurement_came_when_it_came(tmp_path: Path) -> None:
    log = opened(tmp_path, attitudes(30))
    time = log.time[log.fresh[:, log.index("gnss.satellites")]]
    assert time[-1] == pytest.approx(29.9, abs=0.01)
