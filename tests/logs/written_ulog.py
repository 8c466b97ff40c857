"""A small ULog, written byte by byte after PX4's description of the format: shares no code with the reader."""

import struct

import numpy as np

HEAD = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000)
FORMATS = {
    "sensor_combined": (
        "uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;uint8_t[4] _padding0;",
        "<Q6f",
    ),
    "vehicle_gps_position": (
        "uint64_t timestamp;int32_t lat;int32_t lon;int32_t alt;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;",
        "<Q3i3f",
    ),
    "vehicle_air_data": ("uint64_t timestamp;float baro_alt_meter;", "<Qf"),
    "vehicle_attitude": ("uint64_t timestamp;float[4] q;", "<Q4f"),
    "cpuload": ("uint64_t timestamp;float load;", "<Qf"),
}
TOPICS = [*((name, 0) for name in FORMATS), ("vehicle_gps_position", 1)]


def message(kind: str, body: bytes) -> bytes:
    return struct.pack("<HB", len(body), ord(kind)) + body


def data(topic: str, instance: int, *values: float) -> bytes:
    return message("D", struct.pack("<H", TOPICS.index((topic, instance))) + struct.pack(FORMATS[topic][1], *values))


def head() -> bytes:
    written = HEAD + message("B", bytes(40))
    for name, (fields, _) in FORMATS.items():
        written += message("F", f"{name}:{fields}".encode())
    for number, (name, instance) in enumerate(TOPICS):
        written += message("A", struct.pack("<BH", instance, number) + name.encode())
    return written


def flight(seconds: float = 10.0) -> bytes:
    """Inertial unit and attitude at 50 Hz, receivers at 5 Hz, barometer at 10 Hz."""
    random = np.random.default_rng(3)
    written = head()
    for k in range(round(50 * seconds)):
        us, t = 5_000_000 + 20_000 * k, k / 50
        written += data("sensor_combined", 0, us, *random.normal(0, 0.1, 3), *random.normal((0, 0, -9.8), 0.1))
        roll = 0.2 * np.sin(t)
        written += data("vehicle_attitude", 0, us, np.cos(roll / 2), np.sin(roll / 2), 0.0, 0.0)
        if k % 10 == 0:
            for instance in (0, 1):
                place = (round(1e7 * (47 + 1e-5 * t)), round(1e7 * (8 - 1e-5 * t)), round(1e3 * (500 + t)))
                written += data("vehicle_gps_position", instance, us, *place, *random.normal((1, -1, -1), 0.1))
        if k % 5 == 0:
            written += data("vehicle_air_data", 0, us, 500 + t + random.normal(0, 0.1))
        if k % 50 == 0:
            written += data("cpuload", 0, us, 0.3)
    return written
