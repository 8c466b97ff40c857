"""The two real flights of the study, with equal channel names: a PX4 fixed wing (proto) and an UltraStick (thor)."""

from sensorfault.logs.read import read
from sensorfault.logs.table import Log
from sensorfault.logs.vehicle import VehicleFile
from sensorfault_studies.data import real

FLIGHTS = ("proto", "thor")
_GROUND_M = 100.0  # both airfields are above 200 m; before its first fix thor's receiver reports 0

_PROTO = """
[vehicle]
name = "proto"
[file.gps]
path = "Proto_FLT09_vehicle_gps_position_0.csv"
time = "timestamp"
unit = "us"
[file.position]
path = "Proto_FLT09_vehicle_global_position_0.csv"
time = "timestamp"
unit = "us"
[file.attitude]
path = "Proto_FLT09_vehicle_attitude_0.csv"
time = "timestamp"
unit = "us"
[file.controls]
path = "Proto_FLT09_actuator_controls_0_0.csv"
time = "timestamp"
unit = "us"
[file.airspeed]
path = "Proto_FLT09_airspeed_0.csv"
time = "timestamp"
unit = "us"
[sensor.gnss]
file = "gps"
[sensor.gnss.channel]
latitude = { column = "lat", unit = "1e-7deg", watch = false }
longitude = { column = "lon", unit = "1e-7deg", watch = false }
altitude = { column = "alt", unit = "mm" }
north = { column = "vel_n_m_s", unit = "m/s" }
east = { column = "vel_e_m_s", unit = "m/s" }
down = { column = "vel_d_m_s", unit = "m/s" }
[sensor.barometer]
file = "position"
[sensor.barometer.channel]
altitude = { column = "pressure_alt", unit = "m" }
[sensor.attitude]
file = "attitude"
[sensor.attitude.channel]
roll = { column = "roll_of_quaternion [rad]", unit = "rad" }
pitch = { column = "pitch_of_quaternion [rad]", unit = "rad" }
yaw = { column = "yaw_of_quaternion [rad]", unit = "rad", watch = false }
[sensor.gyro]
file = "attitude"
[sensor.gyro.channel]
x = { column = "rollspeed", unit = "rad/s" }
y = { column = "pitchspeed", unit = "rad/s" }
z = { column = "yawspeed", unit = "rad/s" }
[sensor.control]
file = "controls"
[sensor.control.channel]
elevator = { column = "control[1]" }
throttle = { column = "control[3]" }
[sensor.airspeed]
file = "airspeed"
[sensor.airspeed.channel]
airspeed = { column = "indicated_airspeed_m_s", unit = "m/s" }
"""

_THOR = """
[vehicle]
name = "thor"
[file.log]
time = "time"
unit = "s"
[sensor.gnss]
held = true
epoch = "GPS_TOW"
[sensor.gnss.channel]
latitude = { column = "lat", unit = "deg", watch = false }
longitude = { column = "lon", unit = "deg", watch = false }
altitude = { column = "alt", unit = "m" }
north = { column = "vn", unit = "m/s" }
east = { column = "ve", unit = "m/s" }
down = { column = "vd", unit = "m/s" }
[sensor.barometer.channel]
altitude = { column = "h", unit = "m" }
[sensor.attitude.channel]
roll = { column = "phi", unit = "rad" }
pitch = { column = "theta", unit = "rad" }
yaw = { column = "psi", unit = "rad", watch = false }
[sensor.gyro.channel]
x = { column = "p", unit = "rad/s" }
y = { column = "q", unit = "rad/s" }
z = { column = "r", unit = "rad/s" }
[sensor.accelerometer.channel]
x = { column = "ax", unit = "m/s^2" }
y = { column = "ay", unit = "m/s^2" }
z = { column = "az", unit = "m/s^2" }
[sensor.control.channel]
elevator = { column = "de", unit = "rad" }
throttle = { column = "dthr" }
[sensor.airspeed.channel]
airspeed = { column = "ias", unit = "m/s" }
"""


def flight(name: str) -> Log:
    """`proto` (530 s, fixes at 4.9 Hz on a clock of 89 Hz) or `thor` (674 s, fixes at 1 Hz on a clock of 50 Hz).

    Raises:
        LogError: the real data do not exist.
    """
    if name == "proto":
        return read(real("uav/px4_fw_proto_flt09"), VehicleFile.parse(_PROTO))
    (path,) = real("uav/umn_fw_thor75").glob("*.mat")
    log = read(path, VehicleFile.parse(_THOR))
    height = log.value[:, log.index("gnss.altitude")]
    return log.between(float(log.time[height > _GROUND_M][0]))
