"""Logs of autopilots: which of their many messages are sensors, and what their fields are.

PX4: its uORB message definitions (msg/*.msg, comments). ArduPilot: its log messages' FMTU units. MAVLink: common.xml.
Estimates (positions, velocities, biases), commands and statistics of an autopilot are not sensors.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from sensorfault.logs.guess.words import Meaning
from sensorfault.logs.readers.attitude import ANGLES

Fields = Mapping[str, Meaning]


@dataclass(frozen=True)
class Stock:
    """An autopilot. `tells`: one of these tables identifies it. `parts`: for each, the first table that is there."""

    name: str
    tells: frozenset[str]
    parts: tuple[tuple[tuple[str, Fields], ...], ...]

    def fields(self, tables: Collection[str]) -> dict[str, dict[str, Meaning]]:
        """What the fields of the tables that are sensors mean; `NAME[1]`, another device, is like `NAME`."""
        base = {name: name.partition("[")[0] for name in tables}
        found: dict[str, dict[str, Meaning]] = {}
        for part in self.parts:
            first = next((one for one in part if one[0] in base.values()), None)
            if first is not None:
                for name in (name for name in tables if base[name] == first[0]):
                    found.setdefault(name, {}).update(first[1])
        return found


def _field(kind: str, **columns: str) -> Fields:
    """`axis="column unit"`, the unit left out where it has none."""
    return {
        column: Meaning(kind, axis, "", unit)
        for axis, text in columns.items()
        for column, _, unit in (text.partition(" "),)
    }


def _xyz(kind: str, column: str, unit: str, axes: str = "012") -> Fields:
    return _field(kind, **{axis: f"{column.format(mark)} {unit}" for axis, mark in zip("xyz", axes, strict=True)})


_QUATERNION: Fields = {
    ANGLES[0]: Meaning("attitude", "roll", "", "rad"),
    ANGLES[1]: Meaning("attitude", "pitch", "", "rad"),
    ANGLES[2]: Meaning("heading", "yaw", "", "rad"),
}
_GPS_OLD = {
    **_field("position", latitude="lat 1e-7deg", longitude="lon 1e-7deg"),
    **_field("height", altitude="alt mm"),
    **_field("velocity", north="vel_n_m_s m/s", east="vel_e_m_s m/s", down="vel_d_m_s m/s"),
}
_GPS_NEW = {
    **_GPS_OLD,
    **_field("position", latitude="latitude_deg deg", longitude="longitude_deg deg"),
    **_field("height", altitude="altitude_msl_m m"),
}
_AIR = {**_field("barometer", altitude="baro_alt_meter m", pressure="baro_pressure_pa Pa")}
PX4 = Stock(
    "PX4",
    frozenset({"sensor_combined", "vehicle_attitude", "vehicle_gps_position", "sensor_gps"}),
    (
        (("sensor_combined", _xyz("gyro", "gyro_rad[{}]", "rad/s")),),
        (("sensor_combined", _xyz("accelerometer", "accelerometer_m_s2[{}]", "m/s^2")),),
        (
            ("vehicle_magnetometer", _xyz("magnetometer", "magnetometer_ga[{}]", "gauss")),
            ("sensor_combined", _xyz("magnetometer", "magnetometer_ga[{}]", "gauss")),
        ),
        (("vehicle_air_data", _AIR), ("sensor_combined", _AIR)),
        (("sensor_gps", _GPS_NEW), ("vehicle_gps_position", _GPS_NEW)),
        (("vehicle_attitude", _QUATERNION),),
        (("airspeed", _field("airspeed", airspeed="indicated_airspeed_m_s m/s")),),
        (("distance_sensor", _field("range", range="current_distance m")),),
    ),
)
_COURSE = _field("heading", course="GCrs deg")
ARDUPILOT = Stock(
    "ArduPilot",
    frozenset({"ATT", "IMU", "GPS"}),
    (
        *((((name, _xyz("gyro", "Gyr{}", "rad/s", "XYZ")),)) for name in ("IMU", "IMU2", "IMU3")),
        *((((name, _xyz("accelerometer", "Acc{}", "m/s^2", "XYZ")),)) for name in ("IMU", "IMU2", "IMU3")),
        (
            (
                "GPS",
                {
                    **_field("position", latitude="Lat deg", longitude="Lng deg"),
                    **_field("height", altitude="Alt m"),
                    **_field("speed", speed="Spd m/s"),
                    **_field("velocity", down="VZ m/s"),
                    **_COURSE,
                },
            ),
        ),
        (
            ("BARO", _field("barometer", altitude="Alt m", pressure="Press Pa")),
            ("CTUN", _field("barometer", altitude="BarAlt m")),
        ),
        (("ATT", {**_field("attitude", roll="Roll deg", pitch="Pitch deg"), **_field("heading", yaw="Yaw deg")}),),
        (("MAG", _xyz("magnetometer", "Mag{}", "mgauss", "XYZ")),),
        (("ARSP", _field("airspeed", airspeed="Airspeed m/s")),),
        (("RFND", _field("range", range="Dist m")),),
    ),
)
_SCALED = {
    **_xyz("gyro", "{}gyro", "mrad/s", "xyz"),
    **_xyz("accelerometer", "{}acc", "mg", "xyz"),
    **_xyz("magnetometer", "{}mag", "mgauss", "xyz"),
}
_HIGHRES = {
    **_xyz("gyro", "{}gyro", "rad/s", "xyz"),
    **_xyz("accelerometer", "{}acc", "m/s^2", "xyz"),
    **_xyz("magnetometer", "{}mag", "gauss", "xyz"),
    **_field("barometer", pressure="abs_pressure hPa", altitude="pressure_alt m"),
}
_RECEIVED = {
    **_field("position", latitude="lat 1e-7deg", longitude="lon 1e-7deg"),
    **_field("height", altitude="alt mm"),
    **_field("speed", speed="vel cm/s"),
    **_field("heading", course="cog cdeg"),
}
MAVLINK = Stock(
    "MAVLink",
    frozenset({"ATTITUDE", "GPS_RAW_INT", "RAW_IMU", "SCALED_IMU", "HIGHRES_IMU"}),
    (
        (("HIGHRES_IMU", _HIGHRES), ("SCALED_IMU", _SCALED), ("RAW_IMU", _SCALED)),
        (("SCALED_IMU2", _SCALED),),
        (("SCALED_IMU3", _SCALED),),
        (("GPS_RAW_INT", _RECEIVED),),
        (("GPS2_RAW", _RECEIVED),),
        (("SCALED_PRESSURE", _field("barometer", pressure="press_abs hPa")),),
        (
            (
                "ATTITUDE",
                {**_field("attitude", roll="roll rad", pitch="pitch rad"), **_field("heading", yaw="yaw rad")},
            ),
        ),
        (("VFR_HUD", _field("airspeed", airspeed="airspeed m/s")),),
        (("DISTANCE_SENSOR", _field("range", range="current_distance cm")),),
    ),
)


def recognised(tables: Collection[str]) -> Stock | None:
    """The autopilot whose tables these are."""
    return next((one for one in (PX4, ARDUPILOT, MAVLINK) if one.tells & set(tables)), None)
