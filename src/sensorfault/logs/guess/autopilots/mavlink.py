"""MAVLink's messages: common.xml and ardupilotmega.xml."""

from sensorfault.logs.guess.autopilots.fields import Field, fields, motor, quality, xyz
from sensorfault.logs.guess.autopilots.stock import Device, Role, Stock, first_of, state

_PLANE, _SPACE = ("fix_type >= 2",), ("fix_type >= 3",)
_NONE_16, _NONE_8 = 65535.0, 255.0
_FAST = {
    "gyro": xyz("{}gyro", "rad/s"),
    "accelerometer": xyz("{}acc", "m/s^2"),
    "magnetometer": xyz("{}mag", "gauss"),
}
_SCALED = {
    "gyro": xyz("{}gyro", "mrad/s"),
    "accelerometer": xyz("{}acc", "mg"),
    "magnetometer": xyz("{}mag", "mgauss"),
}
_GNSS = (
    Field("latitude", "lat", "1e-7deg", watch=False, valid=_PLANE),
    Field("longitude", "lon", "1e-7deg", watch=False, valid=_PLANE),
    Field("altitude", "alt", "mm", watch=False, valid=_SPACE),
    Field("speed", "vel", "cm/s", valid=_PLANE, missing=_NONE_16),
    Field("course", "cog", "cdeg", watch=False, valid=_PLANE, missing=_NONE_16),
    *quality(fix_type="fix_type"),
    *quality(_NONE_8, satellites="satellites_visible"),
    *quality(_NONE_16, hdop="eph %", vdop="epv %"),  # hundredths
    *quality(eph="h_acc mm", epv="v_acc mm", speed_accuracy="vel_acc mm/s"),
)
_BATTERY = (
    *fields(watch=False, missing=_NONE_16, voltage="voltage_battery mV"),
    *fields(watch=False, missing=-1.0, current="current_battery cA"),
    *quality(-1.0, remaining="battery_remaining %"),
)
_PRESSURE = (*fields(pressure="press_abs hPa"), *quality(temperature="temperature cdegC"))
_RATIOS = quality(
    velocity_ratio="velocity_variance|vel_ratio", position_ratio="pos_horiz_variance|pos_horiz_ratio",
    height_ratio="pos_vert_variance|pos_vert_ratio", magnetometer_ratio="compass_variance|mag_ratio",
    airspeed_ratio="airspeed_variance|tas_ratio",
)  # fmt: skip
_VIBRATION = quality(vibration_x="vibration_x m/s^2", vibration_y="vibration_y m/s^2", vibration_z="vibration_z m/s^2")
_ATTITUDE = (
    *fields("estimate", roll="roll rad", pitch="pitch rad"),
    *fields("estimate", watch=False, yaw="yaw rad"),
)
_LOCAL = fields("estimate", False, x="x m", y="y m", z="z m", north="vx m/s", east="vy m/s", down="vz m/s")
_GLOBAL = fields("estimate", False, latitude="lat 1e-7deg", longitude="lon 1e-7deg", altitude="alt mm")
_RANGE = (*fields(range="current_distance cm"), *fields(range="distance m"), *quality(quality="signal_quality"))
_OUTPUTS = tuple(Field(f"output{i}", f"servo{i}_raw", kind="context", used=True) for i in range(1, 9))
_MOTORS = tuple(
    Device(table, motor(f"current[{i}] cA", f"rpm[{i}] rpm", f"temperature[{i}] degC"), number=first + i)
    for table, first in (("ESC_TELEMETRY_1_TO_4", 1), ("ESC_TELEMETRY_5_TO_8", 5))
    for i in range(4)
)
_FLOW = (
    Field("x", "rate_of_integrated_x", "rad/s"),
    Field("y", "rate_of_integrated_y", "rad/s"),
    Field("x", "flow_rate_x", "rad/s"),
    Field("y", "flow_rate_y", "rad/s"),
    *quality(quality="quality"),
)


def _inertial(role: str) -> tuple[Role, ...]:
    """The first device in one of three messages, the others in their own."""
    first = (("HIGHRES_IMU", _FAST), ("SCALED_IMU", _SCALED), ("RAW_IMU", _SCALED))
    others = (Role(f"{role}{i}", ((Device(f"SCALED_IMU{i}", _SCALED[role]),),)) for i in (2, 3))
    return Role(role, tuple((Device(one, how[role]),) for one, how in first)), *others


MAVLINK = Stock(
    "MAVLink",
    frozenset({"ATTITUDE", "GPS_RAW_INT", "RAW_IMU", "SCALED_IMU", "HIGHRES_IMU"}),
    (
        *(one for role in _SCALED for one in _inertial(role)),
        Role(
            "barometer{}",
            (
                tuple(Device(f"SCALED_PRESSURE{i}", _PRESSURE, number=int(i or 1)) for i in ("", "2", "3")),
                (
                    Device(
                        "HIGHRES_IMU",
                        (*fields(pressure="abs_pressure hPa"), *fields(watch=False, altitude="pressure_alt m")),
                    ),
                ),
            ),
        ),
        Role("gnss{}", ((Device("GPS_RAW_INT", _GNSS), Device("GPS2_RAW", _GNSS, number=2)),)),
        first_of("airspeed", fields(airspeed="airspeed m/s"), "VFR_HUD", single=True),
        first_of("range", _RANGE, "DISTANCE_SENSOR", "RANGEFINDER", single=True),
        first_of("optical_flow", _FLOW, "OPTICAL_FLOW_RAD", "OPTICAL_FLOW", single=True),
        first_of("battery", _BATTERY, "SYS_STATUS", single=True),
        first_of("attitude", _ATTITUDE, "ATTITUDE", single=True),
        first_of("estimated_position", _GLOBAL, "GLOBAL_POSITION_INT", single=True),
        first_of("estimated_local_position", _LOCAL, "LOCAL_POSITION_NED", single=True),
        Role(
            "accelerometer{}_health",
            (
                (
                    Device("VIBRATION", (*_VIBRATION, *quality(clipping="clipping_0"))),
                    *(Device("VIBRATION", quality(clipping=f"clipping_{i}"), number=i + 1) for i in (1, 2)),
                ),
            ),
            of="accelerometer{}",
        ),
        first_of("estimator", _RATIOS, "EKF_STATUS_REPORT", "ESTIMATOR_STATUS", single=True),
        state("armed", ("HEARTBEAT", "armed")),
        state("landed", ("EXTENDED_SYS_STATE", "landed")),
        state("mode", ("HEARTBEAT", "custom_mode")),
        state("throttle", ("VFR_HUD", "throttle")),
        first_of("motors", _OUTPUTS, "SERVO_OUTPUT_RAW", single=True),
        Role("motor{}", (_MOTORS,), single=True),
    ),
)  # fmt: skip
