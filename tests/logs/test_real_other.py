"""Sane guesses on logs that nobody here made: by air, by water and by radio."""

import tarfile
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, VehicleFile, guess, read

pytestmark = pytest.mark.real


def sane(path: Path | list[Path]) -> dict[str, set[str]]:
    """Sensors with their channels as `name [unit]`, after the guess has parsed back and the log has been read."""
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    log = read(path)
    assert (np.diff(log.time) > 0).all()
    assert not (log.fresh & ~np.isfinite(log.value)).any()
    return {s.name: {f"{c.name} [{c.unit}]" for c in s.channels} for s in vehicle.sensors}


def test_underwater_run(real_data: Path) -> None:
    folder = real_data / "underwater" / "snapir_auv"
    found = sane([folder / "GT_trajectory1.csv", folder / "DVL_trajectory1.csv"])
    assert found["dvl"] == {"x [m/s]", "y [m/s]", "z [m/s]"}
    assert found["gnss"] >= {"longitude [rad]", "latitude [rad]", "altitude [m]", "north [m/s]"}
    with pytest.raises(LogError, match="two drives"):
        guess(folder)


def test_acoustic_ranges(real_data: Path) -> None:
    path = real_data / "underwater" / "ugps_g2_acoustic" / "2024-12-05_22-12-34_g2_acoustic.csv"
    assert sane(path)["range"] == {f"r{k} [m]" for k in range(4)}
    log = read(path)
    ranges = log.value[:, log.of("range")]
    assert np.nanmin(ranges) >= 0  # -1 stands for none
    assert np.isnan(ranges[0]).all()


def test_fixed_wing_topics(real_data: Path) -> None:
    folder = real_data / "uav" / "px4_fw_proto_flt09"
    found = sane(folder)
    assert found["gyro"] == {"x [rad/s]", "y [rad/s]", "z [rad/s]"}
    assert found["gnss"] >= {
        "latitude [1e-7deg]",
        "longitude [1e-7deg]",
        "speed [m/s]",
        "course [rad]",
        "altitude [mm]",
    }
    log = read(folder)
    latitude = np.degrees(log.value[:, log.index("gnss.latitude")])
    assert np.nanmedian(latitude) == pytest.approx(45.22, abs=0.05)
    assert log.duration_s == pytest.approx(530, abs=2)


def test_radio_ranges_of_four_anchors(real_data: Path) -> None:
    found = sane(real_data / "ranging" / "uwb_outdoor" / "LOS" / "Trajectory_A" / "Case_1")
    assert {name for name in found if name.endswith("range")} == {f"a{k}_range" for k in (3, 5, 9, 12)}


def test_an_imu_with_two_of_each(real_data: Path) -> None:
    found = sane(real_data / "gnss" / "instinct_tckf_static" / "vn310-imu.csv")
    three = {"x [m/s^2]", "y [m/s^2]", "z [m/s^2]"}
    assert found["imu_accelerometer"] == found["imu_uncomp_accelerometer"] == three
    assert found["imu_gyro"] == {"x [rad/s]", "y [rad/s]", "z [rad/s]"}


def test_a_walk_whose_recording_began_inside_a_line(real_data: Path) -> None:
    path = real_data / "gnss" / "f9p_walk0827" / "imu_1730.csv"
    found = sane(path)
    assert set(found) == {"accelerometer", "gyro"}
    log = read(path)
    assert len(log) == 20455
    assert any("first line is cut off" in note for note in log.notes)
    assert log.epoch_s == pytest.approx(1756402240.96 - 18, abs=1.0)


def test_a_run_of_an_arm(real_data: Path, tmp_path: Path) -> None:
    with tarfile.open(real_data / "arm" / "schunk_arm.tar.gz") as archive:
        archive.extractall(
            tmp_path, [one for one in archive if one.name.startswith("Robot/measurement_85/")], filter="data"
        )
    folder = tmp_path / "Robot" / "measurement_85"
    found = sane(folder)
    assert {name: len(channels) for name, channels in found.items()} == {"input_c": 6, "trajectory_c": 12}
    log = read(folder)
    assert log.duration_s == pytest.approx(4.344, abs=1e-6)
    assert log.period_s == pytest.approx(0.004)
    assert log.value[0, log.of("trajectory_c")[:3]] == pytest.approx([-0.59223, -0.16092, -2.1219])
    assert log.value[0, log.of("input_c")[:3]] == pytest.approx([1.4943, 2.7749, 4.4898])
    assert np.isfinite(log.value).all()
    with pytest.raises(LogError, match="unpack it"):
        read(real_data / "arm" / "schunk_arm.tar.gz")
