"""The same short flight as ArduPilot's text log and as a ground station's MAVLink telemetry."""

import struct

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as mav

START_US = 1_700_000_000 * 10**6

TEXT_HEAD = """FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns
FMT, 129, 31, PARM, Nf, Name,Value
FMT, 130, 45, GPS, QBIHBcLLefffB, TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,U
FMT, 131, 40, IMU, QBffffff, TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ
FMT, 132, 40, BARO, Qff, TimeUS,Alt,Press
FMT, 133, 40, ATT, Qccc, TimeUS,Roll,Pitch,Yaw
FMT, 134, 40, MSG, QZ, TimeUS,Message
PARM, RC1_MIN, 1000
MSG, 100, ArduCopter V4.5, really
"""


def text(seconds: float = 10.0) -> str:
    """Inertial units at 50 Hz, receiver at 5 Hz, barometer and attitude at 10 Hz."""
    random = np.random.default_rng(2)
    lines = [TEXT_HEAD]
    for k in range(round(50 * seconds)):
        us, t = 1_000_000 + 20_000 * k, k / 50
        for i in range(2):
            turned = ", ".join(f"{one:.5f}" for one in (*random.normal(0, 0.1, 3), *random.normal((0, 0, -9.8), 0.1)))
            lines.append(f"IMU, {us}, {i}, {turned}\n")
        if k % 5 == 0:
            lines.append(f"BARO, {us}, {100 + t:.3f}, {95000 - t:.3f}\n")
            lines.append(f"ATT, {us}, {10 * np.sin(t):.2f}, {5 * np.cos(t):.2f}, {90 + t:.2f}\n")
        if k % 10 == 0:
            place = f"{48 + 1e-5 * t:.7f}, {11 + 1e-5 * t:.7f}, {100 + t:.2f}"
            lines.append(
                f"GPS, {us}, 3, {1000 + k}, 2200, 12, 0.8, {place}, {1.3 + 0.01 * (k % 7)}, {k % 360}, -1.0{k % 9}, 1\n"
            )
    return "".join(lines)


def tlog(seconds: float = 10.0, v1: bool = False) -> bytes:
    """Inertial unit and attitude at 10 Hz, receiver at 2 Hz, and what a ground station says itself."""
    random = np.random.default_rng(2)
    own, ground = mav.MAVLink(None, 1, 1), mav.MAVLink(None, 255, 190)
    written = b""

    def put(us: int, link: mav.MAVLink, message: mav.MAVLink_message) -> bytes:
        return struct.pack(">Q", us) + bytes(message.pack(link, force_mavlink1=v1))

    for k in range(round(10 * seconds)):
        us, ms, t = START_US + 100_000 * k, 5000 + 100 * k, k / 10
        turn, push = random.integers(-100, 100, 3), random.normal((0, 0, -1000), 10).astype(int)
        written += put(
            us, own, mav.MAVLink_scaled_imu_message(ms, *map(int, push), *map(int, turn), 200, 10 + k % 7, 400)
        )
        written += put(us, own, mav.MAVLink_attitude_message(ms, 0.2 * np.sin(t), 0.1 * np.cos(t), 1 + t / 50, 0, 0, 0))
        written += put(us, own, mav.MAVLink_scaled_pressure_message(ms, 950 + t / 10, 0.0, 2500))
        if k % 5 == 0:
            place = (round(1e7 * (48 + 1e-5 * t)), round(1e7 * (11 + 1e-5 * t)), round(1000 * (100 + t)))
            written += put(
                us,
                own,
                mav.MAVLink_gps_raw_int_message(ms * 1000, 3, *place, 80, 90, 130 + k % 7, (900 + 10 * k) % 36000, 12),
            )
        if k % 10 == 0:
            written += put(us, ground, mav.MAVLink_heartbeat_message(6, 8, 0, k % 3, 4, 3))
    return written
