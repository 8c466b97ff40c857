"""PX4's topics: its uORB message definitions (msg/*.msg) and their comments, of old and new versions."""

from sensorfault.logs.guess.autopilots.fields import Field, fields, motor, quality, xyz
from sensorfault.logs.guess.autopilots.stock import Device, Role, Stock, first_of, state
from sensorfault.logs.readers.attitude import ANGLES

_PLANE, _SPACE = ("fix_type >= 2",), ("fix_type >= 3",)  # 0 and 1 no fix, 2 in the plane, 3 in space
_VELOCITY = ("vel_ned_valid >= 1", "fix_type >= 3")
_ERRORS = quality(temperature="temperature degC", errors="error_count")
_RAW = "{}_uncalibrated"  # the driver's: its own zero and, of an external magnetometer, its own axes
_AXES = "012"
_AIR = (
    *fields(watch=False, altitude="baro_alt_meter m"),
    *fields(pressure="baro_pressure_pa Pa"),
    *quality(temperature="baro_temp_celcius degC"),
)
_PRESSURE = (Field("pressure", "pressure", "hPa", large=(2000.0, "Pa")), *_ERRORS)  # Pa in new versions
_AIRSPEED = fields(airspeed="indicated_airspeed_m_s m/s", true_airspeed="true_airspeed_m_s m/s")
_OUTPUTS = tuple(
    Field(f"output{i + 1}", f"{name}[{i}]", kind="context", used=True)
    for name in ("control", "output")
    for i in range(8)
)
_MOTORS = tuple(
    Device(
        "esc_status", motor(f"{one}.esc_current A", f"{one}.esc_rpm rpm", f"{one}.esc_temperature degC"), number=i + 1
    )
    for i, one in enumerate(f"esc[{i}]" for i in range(8))
)
_PLACE = (("latitude", "latitude_deg", "deg"), ("latitude", "lat", "1e-7deg"), ("longitude", "longitude_deg", "deg"),
          ("longitude", "lon", "1e-7deg"))  # fmt: skip
_GNSS = (
    *(Field(*one, watch=False, valid=_PLANE) for one in _PLACE),
    Field("altitude", "altitude_msl_m", "m", watch=False, valid=_SPACE),
    Field("altitude", "alt", "mm", watch=False, valid=_SPACE),
    Field("north", "vel_n_m_s", "m/s", valid=_VELOCITY),
    Field("east", "vel_e_m_s", "m/s", valid=_VELOCITY),
    Field("down", "vel_d_m_s", "m/s", valid=_VELOCITY),
    Field("speed", "vel_m_s", "m/s", valid=_PLANE),
    Field("course", "cog_rad", "rad", watch=False, valid=_PLANE),
    *quality(
        fix_type="fix_type", satellites="satellites_used", eph="eph m", epv="epv m", hdop="hdop", vdop="vdop",
        speed_accuracy="s_variance_m_s m/s", course_accuracy="c_variance_rad rad", valid_velocity="vel_ned_valid",
        noise="noise_per_ms", jamming="jamming_indicator", jamming_state="jamming_state",
        spoofing_state="spoofing_state", agc="automatic_gain_control",
    ),
)  # fmt: skip
_RANGE = (*fields(range="current_distance m"), *quality(quality="signal_quality"))
_FLOW = (
    Field("x", "rate_of_pixel_flow[0]", "rad/s"),
    Field("y", "rate_of_pixel_flow[1]", "rad/s"),
    Field("x", "rate_of_pixel_flow_x_integral", "rad/s"),
    Field("y", "rate_of_pixel_flow_y_integral", "rad/s"),
    *quality(quality="quality"),
)
_BATTERY = (
    *fields(watch=False, voltage="voltage_v V", current="current_a A"),
    *quality(remaining="remaining", temperature="temperature degC"),
)
_RATES = (  # of logs without the gyro itself
    (Device("vehicle_angular_velocity", xyz("xyz[{}]", "rad/s", _AXES)),),
    (Device("vehicle_attitude", fields(x="rollspeed rad/s", y="pitchspeed rad/s", z="yawspeed rad/s")),),
)
_ATTITUDE = (
    Field("roll", ANGLES[0], "rad", "estimate"),
    Field("pitch", ANGLES[1], "rad", "estimate"),
    Field("yaw", ANGLES[2], "rad", "estimate", watch=False),
)
_GLOBAL = (
    *fields("estimate", False, latitude="lat deg", longitude="lon deg", altitude="alt m"),
    *quality(eph="eph m", epv="epv m"),
)
_LOCAL = fields("estimate", False, x="x m", y="y m", z="z m", north="vx m/s", east="vy m/s", down="vz m/s")
_RATIOS = quality(
    velocity_ratio="vel_test_ratio", position_ratio="pos_test_ratio", height_ratio="hgt_test_ratio",
    magnetometer_ratio="mag_test_ratio", airspeed_ratio="tas_test_ratio",
)  # fmt: skip
_INNOVATION = quality(  # the old message has other names
    north="gps_hvel[0]|vel_pos_innov[0] m/s", east="gps_hvel[1]|vel_pos_innov[1] m/s",
    down="gps_vvel|vel_pos_innov[2] m/s", x="gps_hpos[0]|vel_pos_innov[3] m", y="gps_hpos[1]|vel_pos_innov[4] m",
    z="baro_vpos|vel_pos_innov[5] m", magnetometer_x="mag_field[0]|mag_innov[0] gauss",
    magnetometer_y="mag_field[1]|mag_innov[1] gauss", magnetometer_z="mag_field[2]|mag_innov[2] gauss",
    yaw="heading|heading_innov rad", airspeed="airspeed|airspeed_innov m/s",
)  # fmt: skip
_SHAKEN = quality(vibration="gyro_vibration_metric rad/s", errors="gyro_error_count")
_CLIPPING = quality(
    vibration="accel_vibration_metric m/s^2", errors="accel_error_count", clipping_x="accel_clipping[0]",
    clipping_y="accel_clipping[1]", clipping_z="accel_clipping[2]",
)  # fmt: skip


def _inertial(
    role: str, column: str, integral: str, unit: str, more: tuple[Field, ...], *instead: tuple[Device, ...]
) -> Role:
    """The selected device, and the others: calibrated, or as their drivers give them."""
    identity = f"{role}_device_id"
    name = "gyro" if role == "gyro" else "accelerometer"
    others = Device("vehicle_imu", xyz(f"rate_of_{integral}[{{}}]", unit, _AXES), (identity,))
    raw = Device(f"sensor_{role}", (*xyz("{}", unit), *_ERRORS), ("device_id",), name=f"{name}{_RAW}")
    selected = Device(
        "sensor_combined", (*xyz(f"{column}[{{}}]", unit, _AXES), *more), (f"sensor_selection.{identity}",)
    )
    return Role(f"{name}{{}}", ((selected, others, raw), *instead))


PX4 = Stock(
    "PX4",
    frozenset({"sensor_combined", "vehicle_attitude", "vehicle_gps_position", "sensor_gps"}),
    (
        _inertial("gyro", "gyro_rad", "delta_angle", "rad/s", quality(clipping="gyro_clipping"), *_RATES),
        _inertial(
            "accel", "accelerometer_m_s2", "delta_velocity", "m/s^2", quality(clipping="accelerometer_clipping")
        ),
        Role(
            "magnetometer{}",
            (
                (
                    Device(
                        "vehicle_magnetometer",
                        xyz("magnetometer_ga[{}]", "gauss", _AXES),
                        ("device_id", "sensor_selection.mag_device_id"),
                    ),
                    Device(
                        "sensor_mag", (*xyz("{}", "gauss"), *_ERRORS), ("device_id",), name=f"magnetometer{_RAW}"
                    ),
                ),
                (Device("sensor_combined", xyz("magnetometer_ga[{}]", "gauss", _AXES)),),
            ),
        ),
        Role(
            "barometer{}",
            (
                (
                    Device("vehicle_air_data", _AIR, ("baro_device_id",)),
                    Device("sensor_baro", _PRESSURE, ("device_id",)),
                ),
                (Device("sensor_combined", _AIR),),
                (Device("vehicle_global_position", fields(watch=False, altitude="pressure_alt m")),),
            ),
        ),
        first_of("gnss{}", _GNSS, "sensor_gps", "vehicle_gps_position", sure=True),
        first_of("airspeed{}", _AIRSPEED, "airspeed"),
        first_of("range{}", _RANGE, "distance_sensor"),
        first_of("optical_flow{}", _FLOW, "sensor_optical_flow", "vehicle_optical_flow", "optical_flow"),
        first_of("battery{}", _BATTERY, "battery_status"),
        first_of("attitude", _ATTITUDE, "vehicle_attitude", single=True),
        first_of("estimated_position", _GLOBAL, "vehicle_global_position", single=True),
        first_of("estimated_local_position", _LOCAL, "vehicle_local_position", single=True),
        first_of("gyro{}_health", _SHAKEN, "vehicle_imu_status", of="gyro{}", identity=("gyro_device_id",)),
        first_of(
            "accelerometer{}_health",
            _CLIPPING,
            "vehicle_imu_status",
            of="accelerometer{}",
            identity=("accel_device_id",),
        ),
        first_of("estimator", _RATIOS, "estimator_status", single=True),
        first_of("estimator_innovation", _INNOVATION, "estimator_innovations", "ekf2_innovations", single=True),
        state("armed", ("vehicle_status", "armed"), ("actuator_armed", "armed")),
        state("landed", ("vehicle_land_detected", "landed")),
        state("mode", ("vehicle_status", "nav_state")),
        state("throttle", ("actuator_controls_0", "control[3]"), ("vehicle_thrust_setpoint", "xyz[2]")),
        first_of("motors", _OUTPUTS, "actuator_motors", "actuator_outputs", single=True),
        Role("motor{}", (_MOTORS,), single=True),
    ),
)  # fmt: skip
