"""ArduPilot's log messages (its LogStructure.h, and those of old versions), in binary and text logs."""

from sensorfault.logs.guess.autopilots.fields import Field, fields, motor, quality, xyz
from sensorfault.logs.guess.autopilots.stock import Device, Role, Stock, first_of, state

_PLANE, _SPACE = ("Status >= 2",), ("Status >= 3",)  # 0 no receiver, 1 no fix, 2 in the plane, 3 in space
_GYRO = (*xyz("Gyr{}", "rad/s", "XYZ"), *quality(healthy="GH|GyHlt", errors="EG|ErrG", temperature="T|Temp degC"))
_ACCELEROMETER = (*xyz("Acc{}", "m/s^2", "XYZ"), *quality(healthy="AH|AcHlt", errors="EA|ErrA"))
_MAGNETOMETER = (*xyz("Mag{}", "mgauss", "XYZ"), *quality(healthy="Health"))
_BAROMETER = (
    *fields(watch=False, altitude="Alt m"),
    *fields(pressure="Press Pa"),
    *quality(healthy="Health|H", temperature="Temp degC"),
)
_GNSS = (
    Field("latitude", "Lat", "deg", watch=False, valid=_PLANE),
    Field("longitude", "Lng", "deg", watch=False, valid=_PLANE),
    Field("altitude", "Alt", "m", watch=False, valid=_SPACE),
    Field("speed", "Spd", "m/s", valid=_PLANE),
    Field("course", "GCrs", "deg", watch=False, valid=_PLANE),
    Field("down", "VZ", "m/s", valid=_SPACE),
    *quality(fix_type="Status", satellites="NSats", hdop="HDop"),
)
_ACCURACY = quality(
    eph="HAcc|hAcc m", epv="VAcc|vAcc m", speed_accuracy="SAcc|sAcc m/s", vdop="VDop", valid_velocity="VV"
)
_SIGNAL = quality(noise="noisePerMS", jamming="jamInd", agc="agcCnt")
_AIRSPEED = (*fields(airspeed="Airspeed m/s"), *quality(healthy="H|Health", temperature="Temp degC"))
_OLD_CURRENT = (  # with the throttle in the same message, and in hundredths
    Field("voltage", "Volt", "cV", watch=False, needs="ThrOut"),
    Field("current", "Curr", "cA", watch=False, needs="ThrOut"),
)
_BATTERY = (
    *_OLD_CURRENT,
    *fields(watch=False, voltage="Volt V", current="Curr A"),
    *quality(remaining="RemPct %", temperature="Temp degC"),
)
_RATIOS = quality(
    velocity_ratio="SV", position_ratio="SP", height_ratio="SH", magnetometer_ratio="SM|SMX", airspeed_ratio="SVT"
)
_INNOVATION = quality(
    north="IVN m/s", east="IVE m/s", down="IVD m/s", x="IPN m", y="IPE m", z="IPD m", magnetometer_x="IMX mgauss",
    magnetometer_y="IMY mgauss", magnetometer_z="IMZ mgauss", yaw="IYAW deg", airspeed="IVT m/s",
)  # fmt: skip
_PLACE = fields("estimate", False, latitude="Lat deg", longitude="Lng deg", altitude="Alt m")
_WAY = fields("estimate", False, x="PN m", y="PE m", z="PD m", north="VN m/s", east="VE m/s", down="VD m/s")
_ATTITUDE = (
    *fields("estimate", roll="Roll deg", pitch="Pitch deg"),
    *fields("estimate", watch=False, yaw="Yaw deg"),
)
_VIBRATION = quality(vibration_x="VibeX m/s^2", vibration_y="VibeY m/s^2", vibration_z="VibeZ m/s^2")
_MOTOR = motor("Curr A", "RPM rpm", "Temp degC")
_OUTPUTS = tuple(
    Field(f"output{i}", name.format(i), kind="context", used=True) for name in ("C{}", "Ch{}") for i in range(1, 9)
)


def _each(what: tuple[Field, ...], *tables: str, sure: bool = False) -> tuple[Device, ...]:
    """A table for each device, or one with an instance for each."""
    return tuple(Device(table, what, number=i, sure=sure) for i, table in enumerate(tables, 1))


ARDUPILOT = Stock(
    "ArduPilot",
    frozenset({"ATT", "IMU", "GPS"}),
    (
        Role(
            "gyro{}",
            (_each(_GYRO, "IMU", "IMU2", "IMU3"), _each(_GYRO, "GYR1", "GYR2", "GYR3"), _each(_GYRO, "GYR")),
        ),
        Role(
            "accelerometer{}",
            (
                _each(_ACCELEROMETER, "IMU", "IMU2", "IMU3"),
                _each(_ACCELEROMETER, "ACC1", "ACC2", "ACC3"),
                _each(_ACCELEROMETER, "ACC"),
            ),
        ),
        Role("magnetometer{}", (_each(_MAGNETOMETER, "MAG", "MAG2", "MAG3"),)),
        Role(
            "barometer{}",
            (
                _each(_BAROMETER, "BARO", "BAR2", "BAR3"),
                _each(fields(watch=False, altitude="BarAlt|BAlt m"), "CTUN"),
            ),
        ),
        Role("gnss{}", (_each(_GNSS, "GPS", "GPS2"),)),
        Role("airspeed{}", (_each(_AIRSPEED, "ARSP", "ASP2"),)),
        Role(
            "range{}",
            (
                _each((*fields(range="Dist m"), *quality(quality="Quality", status="Stat")), "RFND"),
                (Device("RFND", fields(range="Dist1 m")), Device("RFND", fields(range="Dist2 m"), number=2)),
            ),
        ),
        first_of("optical_flow{}", (*fields(x="flowX rad/s", y="flowY rad/s"), *quality(quality="Qual")), "OF"),
        Role("battery{}", (_each(_BATTERY, "BAT", "BAT2"), _each(_BATTERY, "CURR", "CUR2"))),
        first_of("attitude", _ATTITUDE, "ATT"),
        first_of("estimated_position", _PLACE, "POS"),
        first_of("estimated_local_position", _WAY, "XKF1", "NKF1", "EKF1", single=True),
        Role("gnss{}_health", (_each(_ACCURACY, "GPA", "GPA2"), _each(_ACCURACY, "UBX3")), of="gnss{}"),
        Role("gnss{}_signal", (_each(_SIGNAL, "UBX1"),), of="gnss{}"),
        Role(
            "accelerometer{}_health",
            (
                (
                    Device("VIBE", (*_VIBRATION, *quality(clipping="Clip|Clip0"))),
                    *(Device("VIBE", quality(clipping=f"Clip{i}"), number=i + 1) for i in (1, 2)),
                ),
            ),
            of="accelerometer{}",
        ),
        first_of("estimator", _RATIOS, "XKF4", "NKF4", "EKF4", single=True),
        first_of("estimator_innovation", _INNOVATION, "XKF3", "NKF3", "EKF3", single=True),
        state("armed", ("ARM", "ArmState"), ("EV", "armed"), ("STAT", "Armed")),
        state("landed", ("EV", "landed")),
        state("mode", ("MODE", "ModeNum"), ("MODE", "Mode")),
        state("throttle", ("CTUN", "ThO"), ("CTUN", "ThrOut"), ("CURR", "ThrOut")),
        first_of("motors", _OUTPUTS, "RCOU", single=True),
        Role("motor{}", (_each(_MOTOR, "ESC"), _each(_MOTOR, *(f"ESC{i}" for i in range(1, 9))))),
    ),
)  # fmt: skip
