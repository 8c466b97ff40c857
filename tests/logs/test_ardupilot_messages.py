"""ArduPilot's messages of old and new firmwares: every device, what it says of itself, and what holds."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, LogError, VehicleFile, guess, read

SECONDS = 10
Row = Callable[[float], tuple[object, ...]]
RANDOM = np.random.default_rng(6)


def text(kinds: dict[str, tuple[str, float, list[Row]]], once: tuple[str, ...] = (), time: str = "TimeUS") -> str:
    """`kind` -> its cells after the time, its rate [Hz], and for each of its devices what it says at a time [s]."""
    lines, head = [], []
    for number, (kind, (cells, rate, devices)) in enumerate(kinds.items(), 130):
        head += [f"FMT, {number}, 40, {kind}, Q, {time},{cells}\n"]
        units = "".join("#" if cell in ("I", "IMU", "C", "Instance") else "-" for cell in cells.split(","))
        head += [f"FMTU, 0, {number}, s{units}, F{'-' * len(units)}\n"]
        for k in range(round(rate * SECONDS)):
            t = k / rate
            lines += [(t, f"{kind}, {at(t, time)}, {', '.join(map(str, device(t)))}\n") for device in devices]
    known = (
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 129, 40, FMTU, QBNN, TimeUS,FmtType,UnitIds\n"
    )
    return known + "".join(head) + "".join(once) + "".join(line for _, line in sorted(lines, key=lambda one: one[0]))


def at(seconds: float, time: str = "TimeUS") -> int:
    return round((2 + seconds) * (1e6 if time == "TimeUS" else 1e3))


def three(mean: float = 0.0, spread: float = 0.1) -> tuple[float, ...]:
    return tuple(RANDOM.normal(mean, spread, 3).round(5))


def written(folder: Path, content: str) -> Log:
    path = folder / "flight.log"
    path.write_text(content)
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    return read(path)


def news(log: Log, path: str) -> np.ndarray:
    i = log.index(path)
    return log.value[log.fresh[:, i], i]


def fix(device: int, begin: float) -> Row:
    """Nothing before `begin`, then in the plane for a second, then in space."""

    def row(t: float) -> tuple[object, ...]:
        status = 1 if t < begin else 2 if t < begin + 1 else 3
        place = (0, 0, 0, 0, 0) if status == 1 else (48.1 + 1e-6 * t, 11.5, 500 + t, 1.5, 90)
        return device, status, 0 if status == 1 else 9, 0.8, *place, 0.1

    return row


def new_firmware() -> dict[str, tuple[str, float, list[Row]]]:
    return {
        "IMU": (
            "I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH",
            25,
            [lambda t, i=i: (i, *three(i), *three(), 0, i, 40 + i, 1, 1 - i % 2) for i in range(3)],
        ),
        "MAG": ("I,MagX,MagY,MagZ,Health", 10, [lambda t, i=i: (i, *three(100 * (i + 1)), 1) for i in range(2)]),
        "BARO": ("I,Alt,Press,Temp,Health", 10, [lambda t, i=i: (i, t, 95_000 + i, 30, 1) for i in range(2)]),
        "GPS": ("I,Status,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ", 5, [fix(0, 4), fix(1, 99)]),
        "GPA": ("I,VDop,HAcc,VAcc,SAcc,VV", 5, [lambda t, i=i: (i, 1, 0.5 + i, 0.9, 0.2, 1) for i in range(2)]),
        "VIBE": ("IMU,VibeX,VibeY,VibeZ,Clip", 10, [lambda t, i=i: (i, *three(9), 5 * i) for i in range(3)]),
        "BAT": ("Instance,Volt,Curr,RemPct", 10, [lambda t, i=i: (i, 12 + i, 3, 97) for i in range(2)]),
        "XKF4": ("C,SV,SP,SH,SM,SVT", 10, [lambda t, i=i: (i, 0.2, 0.1, 0.1, 0.3 + i, 0) for i in range(2)]),
        "ATT": ("Roll,Pitch,Yaw", 10, [lambda t: (t, -t, 90 + t)]),
        "ARSP": ("I,Airspeed,Temp,H", 10, [lambda t: (0, 15 + RANDOM.normal(), 30, 1)]),
        "RFND": ("Instance,Dist,Stat", 10, [lambda t, i=i: (i, 3 * i + RANDOM.normal(), 4) for i in range(2)]),
        "OF": ("Qual,flowX,flowY", 10, [lambda t: (200, RANDOM.normal(1), RANDOM.normal(2))]),
        "CTUN": ("ThI,ThO,BAlt", 10, [lambda t: (0.5, 0.3 + 0.01 * t, t)]),
        "RCOU": ("C1,C2,C3", 10, [lambda t: (1500, 1400, 0)]),
        "ESC": ("Instance,RPM,Curr", 10, [lambda t, i=i: (i, 6000, 5 + i) for i in range(4)]),
        "MODE": ("Mode,ModeNum,Rsn", 0, []),
        "EV": ("Id", 0, []),
    }


STATES = ("MODE, 1000000, Loiter, 5, 1\n", f"EV, {at(1)}, 10\n", f"EV, {at(2)}, 28\n", f"EV, {at(8)}, 18\n",
          f"EV, {at(9)}, 11\n")  # fmt: skip


def test_every_device_of_a_new_firmware(tmp_path: Path) -> None:
    log = written(tmp_path, text(new_firmware(), STATES))
    roles = {"gyro": 3, "accelerometer": 3, "magnetometer": 2, "barometer": 2, "gnss": 2, "battery": 2, "range": 2}
    roles |= {"airspeed": 1, "optical_flow": 1, "attitude": 1}
    devices = {f"{role}{'' if i == 1 else i}" for role, count in roles.items() for i in range(1, count + 1)}
    assert {sensor.name for sensor in log.measurements().sensors} == devices
    for i, name in enumerate(("gyro", "gyro2", "gyro3")):
        assert len(news(log, f"{name}.x")) == 25 * SECONDS
        assert news(log, f"{name}.x").mean() == pytest.approx(i, abs=0.1)
        assert set(news(log, f"accelerometer{name[4:]}.healthy")) == {1 - i % 2}
        assert set(news(log, f"accelerometer{name[4:]}_health.clipping")) == {5 * i}
    assert news(log, "magnetometer2.x").mean() == pytest.approx(200e-7, rel=0.01)
    assert news(log, "barometer2.pressure")[0] == 95_001
    assert set(news(log, "gnss2_health.eph")) == {1.5}
    assert set(news(log, "estimator.magnetometer_ratio")) == {0.3}
    assert news(log, "optical_flow.y").mean() == pytest.approx(2, abs=0.5)
    assert set(news(log, "motor4.current")) == {8}
    assert news(log, "motor.speed")[0] == pytest.approx(6000 * 2 * np.pi / 60)
    assert {channel.path for channel in log.channels if channel.sensor == "motors"} == {
        "motors.output1",
        "motors.output2",
    }


def test_rows_without_a_fix_have_no_position(tmp_path: Path) -> None:
    log = written(tmp_path, text(new_firmware(), STATES))
    time = log.time[log.fresh[:, log.index("gnss.latitude")]]
    assert time[0] == pytest.approx(4.0, abs=0.05)
    assert log.time[log.fresh[:, log.index("gnss.altitude")]][0] == pytest.approx(5.0, abs=0.05)
    assert len(news(log, "gnss.fix_type")) == len(news(log, "gnss2.fix_type")) == 5 * SECONDS
    assert set(news(log, "gnss2.fix_type")) == {1}
    assert len(news(log, "gnss2.latitude")) == 0
    assert not any("empty" in note for note in log.notes)


def test_states_hold_until_the_next(tmp_path: Path) -> None:
    log = written(tmp_path, text(new_firmware(), STATES))
    kinds = {channel.path: channel.kind for channel in log.channels}
    assert {kinds[path] for path in ("armed.armed", "landed.landed", "mode.mode", "throttle.throttle")} == {"context"}
    assert log.time[0] == 0
    assert log.value[0, log.index("mode.mode")] == 5  # said before the first row
    changes = {path: log.index(path) for path in ("armed.armed", "landed.landed")}
    held = {path: log.value[log.fresh[:, i], i] for path, i in changes.items()}
    assert held["armed.armed"].tolist() == [1, 1, 1, 0]
    assert held["landed.landed"].tolist() == [0, 1, 1]
    assert log.time[log.fresh[:, changes["landed.landed"]]][:2] == pytest.approx([2.0, 8.0], abs=0.05)


def test_every_device_of_an_old_firmware(tmp_path: Path) -> None:
    imu = "GyrX,GyrY,GyrZ,AccX,AccY,AccZ"
    kinds = {
        "IMU": (imu, 50, [lambda t: (*three(0), *three())]),
        "IMU2": (imu, 50, [lambda t: (*three(1), *three())]),
        "IMU3": (imu, 50, [lambda t: (*three(2), *three())]),
        "MAG": ("MagX,MagY,MagZ", 10, [lambda t: (0, 0, 0)]),
        "MAG2": ("MagX,MagY,MagZ", 10, [lambda t: three(200)]),
        "BARO": ("Alt,Press", 10, [lambda t: (t, 95_000 + t)]),
        "BAR2": ("Alt,Press", 10, [lambda t: (t, 94_000 + t)]),
        "GPS2": ("Status,NSats,Lat,Lng,Alt,Spd,GCrs,VZ", 5, [lambda t: (3, 9, 48 + 1e-6 * t, 11, 500, 1 + t, 90, 0.1)]),
        "CURR": ("ThrOut,ThrInt,Volt,Curr", 10, [lambda t: (500, 0, 1150, 2000)]),
        "VIBE": ("VibeX,VibeY,VibeZ,Clip0,Clip1,Clip2", 10, [lambda t: (*three(9), 0, 7, 8)]),
        "EKF4": ("SV,SP,SH,SMX,SVT", 10, [lambda t: (0.2, 0.1, 0.1, 0.4, 0)]),
    }
    log = written(tmp_path, text(kinds, time="TimeMS"))
    names = {sensor.name for sensor in log.sensors}
    assert {"gyro", "gyro2", "gyro3", "magnetometer2", "barometer", "barometer2", "gnss2", "battery"} <= names
    assert "magnetometer" not in names
    assert any("MAG has only zeros for magnetometer: no such device." in note for note in log.notes)
    assert news(log, "gyro3.y").mean() == pytest.approx(2, abs=0.1)
    assert set(news(log, "battery.voltage")) == {11.5}
    assert set(news(log, "battery.current")) == {20.0}
    assert set(news(log, "accelerometer2_health.clipping")) == {7}
    assert set(news(log, "estimator.magnetometer_ratio")) == {0.4}
    assert set(news(log, "throttle.throttle")) == {500}


def test_messages_without_a_time_are_dated_by_their_place(tmp_path: Path) -> None:
    head = "FMT, 130, 45, GPS, BIHBcLLeeEefI, Status,NSats,Lat,Lng,Alt,Spd,GCrs,VZ,T\n"
    head += "FMT, 1, 17, ATT, cccC, Roll,Pitch,Yaw\n"
    lines = [f"ATT, {0}, 0, 0\n"]
    for k in range(50):
        lines.append(f"GPS, 3, 9, {48 + 1e-6 * k}, 11.5, 100, {1 + 0.1 * (k % 3)}, {k}, 0.1, {5000 + 200 * k}\n")
        lines += [f"ATT, {10 * np.sin(k + j / 2)}, {j - 1}.5, {k}\n" for j in range(2)]
    log = written(tmp_path, head + "".join(lines))
    assert log.duration_s == pytest.approx(9.8, abs=0.15)
    rows = np.flatnonzero(log.fresh[:, log.index("attitude.roll")])
    assert len(rows) == 98  # neither the one before the first fix, nor those behind the last
    third = 0.2 / 3
    assert log.time[rows[1]] - log.time[rows[0]] == pytest.approx(third, abs=1e-6)
    assert any("messages without a time are dated by their place among the others: ATT." in note for note in log.notes)
    assert log.damage == ()


def test_a_table_of_states_alone_is_no_log(tmp_path: Path) -> None:
    (tmp_path / "flight.log").write_text(text({"MODE": ("ModeNum", 1, [lambda t: (5,)])}))
    with pytest.raises(LogError, match="looks like a measurement"):
        read(tmp_path / "flight.log")


def test_a_description_fits_a_flight_without_its_states(tmp_path: Path) -> None:
    kinds = new_firmware()
    (tmp_path / "first.log").write_text(text(kinds, STATES))
    vehicle = guess(tmp_path / "first.log")
    assert {"armed", "mode"} <= {sensor.name for sensor in vehicle.sensors}
    (tmp_path / "second.log").write_text(text(kinds))  # neither armed nor changed its mode
    log = read(tmp_path / "second.log", vehicle)
    assert {sensor.name for sensor in vehicle.sensors} - {sensor.name for sensor in log.sensors} == {
        "armed",
        "landed",
        "mode",
    }
    assert len(news(log, "gyro3.x")) == 25 * SECONDS
    del kinds["BARO"]
    (tmp_path / "third.log").write_text(text(kinds))
    with pytest.raises(LogError, match="there is no table 'BARO' in it"):
        read(tmp_path / "third.log", vehicle)
