"""PX4's topics of old and new versions: every device once, by role and number; what it says of itself; what holds."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from logs.written_topics import ulog
from sensorfault.logs import Log, VehicleFile, guess, read

Topics = dict[tuple[str, int], tuple[str, float, Mapping[str, Sequence[float] | float]]]
RANDOM = np.random.default_rng(4)
SECONDS = 10


def noise(rate: int, mean: float = 0.0) -> np.ndarray:
    return RANDOM.normal(mean, 0.1, rate * SECONDS)


def axes(name: str, rate: int, *means: float) -> dict[str, np.ndarray]:
    return {name.format(i): noise(rate, mean) for i, mean in enumerate(means)}


def combined() -> Topics:
    inertial = axes("gyro_rad[{}]", 50, 0.1, 0.2, 0.3) | axes("accelerometer_m_s2[{}]", 50, 0, 0, -9.8)
    return {("sensor_combined", 0): ("ffB", 50, inertial | {"accelerometer_clipping": 0})}


def written(folder: Path, topics: Topics) -> Log:
    path = folder / "flight.ulg"
    path.write_bytes(ulog(topics))
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    return read(path)


def news(log: Log, path: str) -> np.ndarray:
    i = log.index(path)
    return log.value[log.fresh[:, i], i]


def kinds(log: Log) -> dict[str, str]:
    return {channel.path: channel.kind for channel in log.channels}


def test_a_receiver_without_a_fix_is_there(tmp_path: Path) -> None:
    fields = {"latitude_deg": 0.0, "longitude_deg": 0.0, "altitude_msl_m": 0.0, "vel_n_m_s": 0.0, "vel_e_m_s": 0.0}
    fields |= {"vel_d_m_s": 0.0, "fix_type": 0, "satellites_used": 0, "jamming_indicator": 30, "vel_ned_valid": 0}
    none = "dddfffBBiB", 5, fields | {"eph": np.full(5 * SECONDS, 999.0)}
    late = {name: np.where(np.arange(5 * SECONDS) < 10, 0, one) for name, one in
            {"latitude_deg": 47.5, "longitude_deg": 8.5, "altitude_msl_m": 500.0, "vel_n_m_s": 1.0, "vel_e_m_s": 0.1,
             "vel_d_m_s": 0.1, "fix_type": 3, "satellites_used": 9, "jamming_indicator": 30, "vel_ned_valid": 1,
             "eph": 1.0}.items()}  # fmt: skip
    late["latitude_deg"] = late["latitude_deg"] + 1e-6 * np.arange(5 * SECONDS)
    form = "dddfffBBiBf"
    log = written(
        tmp_path, combined() | {("sensor_gps", 0): (form, none[1], none[2]), ("sensor_gps", 1): (form, 5, late)}
    )
    assert not np.isfinite(log.value[:, log.index("gnss.latitude")]).any()
    assert len(news(log, "gnss.fix_type")) == 5 * SECONDS
    assert set(news(log, "gnss.jamming")) == {30}
    assert len(news(log, "gnss2.latitude")) == 5 * SECONDS - 10
    assert len(news(log, "gnss2.north")) == 5 * SECONDS - 10
    assert len(news(log, "gnss2.satellites")) == 5 * SECONDS
    assert np.rad2deg(news(log, "gnss2.latitude")[0]) == pytest.approx(47.50001, abs=1e-6)
    assert kinds(log)["gnss2.eph"] == "quality"
    assert kinds(log)["gnss2.latitude"] == ""


def inertial_units(selected: int) -> Topics:
    """Three devices; the autopilot has selected one of them."""
    found: Topics = combined() | {
        ("sensor_selection", 0): ("II", 1, {"gyro_device_id": [selected] * 3, "accel_device_id": [10, 10, 10]})
    }
    for i, device in enumerate((10, 20, 30)):
        raw = {"device_id": float(device)} | {axis: noise(1, i) for axis in "xyz"}
        found["sensor_gyro", i] = "Ifff", 1, raw
    for i, device in enumerate((10, 20)):
        turned = axes("delta_angle[{}]", 2, 0.0, 0.0, 0.0)
        turned = {name: 0.005 * (one + i + 1) for name, one in turned.items()}
        pushed = {f"delta_velocity[{k}]": 1e-4 * noise(2) - 0.049 * (k == 2) for k in range(3)}
        ids = {"accel_device_id": float(device), "gyro_device_id": float(device)}
        over = {"delta_angle_dt": 5000, "delta_velocity_dt": 5000}
        found["vehicle_imu", i] = "IIffII", 2, ids | turned | pushed | over
        shaken = {"accel_clipping[0]": 0, "accel_clipping[1]": 1, "accel_clipping[2]": 2}
        shaken |= {"accel_vibration_metric": noise(1), "gyro_vibration_metric": noise(1)}
        found["vehicle_imu_status", i] = "IIIff", 1, ids | shaken
    return found


def test_the_selected_device_counts_once(tmp_path: Path) -> None:
    log = written(tmp_path, inertial_units(10))
    names = {sensor.name for sensor in log.sensors}
    assert names == {
        "gyro", "gyro2", "gyro3_uncalibrated", "accelerometer", "accelerometer2", "gyro_health", "gyro2_health",
        "accelerometer_health", "accelerometer2_health",
    }  # fmt: skip
    assert news(log, "gyro2.x").mean() == pytest.approx(2.0, abs=0.1)  # rad in 5 ms -> rad/s, of the second
    assert news(log, "gyro3_uncalibrated.x").mean() == pytest.approx(2.0, abs=0.2)
    assert news(log, "accelerometer2.z").mean() == pytest.approx(-9.8, abs=0.01)
    assert set(news(log, "accelerometer2_health.clipping_z")) == {2}


def test_another_selection(tmp_path: Path) -> None:
    log = written(tmp_path, inertial_units(20))
    assert news(log, "gyro2.x").mean() == pytest.approx(1.0, abs=0.1)


def test_a_device_that_may_be_the_selected_one_is_no_second(tmp_path: Path) -> None:
    topics = inertial_units(10)
    del topics["sensor_selection", 0]
    assert not {"gyro2", "gyro2_uncalibrated"} & {sensor.name for sensor in written(tmp_path, topics).sensors}


@pytest.mark.parametrize(("unit", "pressure"), [("hPa", 950.0), ("Pa", 95_000.0)])
def test_barometers_of_old_and_new_versions(tmp_path: Path, unit: str, pressure: float) -> None:
    own = {"baro_device_id": 1.0, "baro_alt_meter": noise(5, 500), "baro_pressure_pa": noise(5, 95_000)}
    others = {device: {"device_id": float(device), "pressure": noise(1, pressure)} for device in (1, 2)}
    log = written(
        tmp_path,
        combined()
        | {("vehicle_air_data", 0): ("Iff", 5, own)}
        | {("sensor_baro", i): ("If", 1, one) for i, one in enumerate(others.values())},
    )
    assert news(log, "barometer.pressure").mean() == pytest.approx(95_000, abs=1)
    assert news(log, "barometer2.pressure").mean() == pytest.approx(95_000, abs=50)
    assert len([sensor for sensor in log.sensors if sensor.name.startswith("barometer")]) == 2


def test_other_sensors_state_and_estimates(tmp_path: Path) -> None:
    armed = np.where(np.arange(20) < 5, 1, 2)
    topics = combined() | {
        ("airspeed", 0): ("ff", 10, {"indicated_airspeed_m_s": noise(10, 15), "true_airspeed_m_s": noise(10, 16)}),
        ("airspeed", 1): ("ff", 10, {"indicated_airspeed_m_s": noise(10, 14), "true_airspeed_m_s": noise(10, 15)}),
        ("distance_sensor", 0): ("fi", 10, {"current_distance": noise(10, 3), "signal_quality": 80}),
        ("sensor_optical_flow", 0): (
            "fIB", 10, axes("pixel_flow[{}]", 10, 0.05, 0.1) | {"integration_timespan_us": 100_000, "quality": 200},
        ),
        ("battery_status", 0): ("fff", 2, {"voltage_v": noise(2, 16), "current_a": noise(2, 9), "remaining": 0.8}),
        ("battery_status", 1): ("fff", 2, {"voltage_v": noise(2, 12), "current_a": noise(2, 1), "remaining": 0.5}),
        ("vehicle_attitude", 0): ("f", 50, {"q[0]": noise(50), "q[1]": 0.1, "q[2]": 0.0, "q[3]": 0.0}),
        ("vehicle_local_position", 0): (
            "ffffff", 10, {one: noise(10, i) for i, one in enumerate(("x", "y", "z", "vx", "vy", "vz"))},
        ),
        ("vehicle_status", 0): ("BB", 2, {"arming_state": armed, "nav_state": 4}),
        ("vehicle_land_detected", 0): ("B", 1, {"landed": np.ones(SECONDS)}),
        ("actuator_motors", 0): ("f", 10, axes("control[{}]", 10, 0.4, 0.4, 0.4, 0.4)),
        ("estimator_status", 0): ("ff", 5, {"mag_test_ratio": noise(5, 0.1), "vel_test_ratio": noise(5, 0.2)}),
    }  # fmt: skip
    log = written(tmp_path, topics)
    assert news(log, "airspeed2.true_airspeed").mean() == pytest.approx(15, abs=0.1)
    assert news(log, "range.range").mean() == pytest.approx(3, abs=0.1)
    assert news(log, "optical_flow.y").mean() == pytest.approx(1.0, abs=0.2)
    assert set(news(log, "optical_flow.quality")) == {200}
    assert news(log, "battery2.voltage").mean() == pytest.approx(12, abs=0.1)
    np.testing.assert_array_equal(news(log, "armed.armed"), armed == 2)
    assert set(news(log, "mode.mode")) == {4}
    assert set(news(log, "landed.landed")) == {1}
    assert news(log, "estimated_local_position.north").mean() == pytest.approx(3, abs=0.1)
    found = kinds(log)
    assert {found[f"attitude.{axis}"] for axis in ("roll", "pitch", "yaw")} == {"estimate"}
    assert {one for path, one in found.items() if path.startswith("estimated")} == {"estimate"}
    assert {found["armed.armed"], found["mode.mode"], found["landed.landed"], found["motors.output1"]} == {"context"}
    assert {found["estimator.magnetometer_ratio"], found["battery.remaining"]} == {"quality"}
    assert not any(channel.watch for channel in log.channels if channel.kind in ("quality", "context"))
    kept = {sensor.name for sensor in log.measurements().sensors}
    assert kept == {
        "gyro", "accelerometer", "airspeed", "airspeed2", "range", "optical_flow", "battery", "battery2", "attitude",
    }  # fmt: skip
    assert {channel.kind for channel in log.measurements().channels} == {"", "estimate"}
