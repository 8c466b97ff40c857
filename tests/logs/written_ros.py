"""A drive as ROS writes it: by rosbags' own writers, and as MCAP by mcap's."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType, Writer
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

START_NS = 1_700_000_000 * 10**9
OWN = "float64 wheel\nfloat32[2] pair\nfloat64[] scan\nstring name\n"
SECONDS = 4.0


def messages(store: Any, seconds: float) -> list[tuple[str, str, int, Any]]:
    """Topic, type, time [ns] and message: IMU at 50 Hz, receiver at 5 Hz, and what else a bag has."""
    t = store.types
    vector, quaternion = t["geometry_msgs/msg/Vector3"], t["geometry_msgs/msg/Quaternion"]
    random = np.random.default_rng(1)
    own = "own_msgs/msg/Own"
    written = []
    for k in range(round(50 * seconds)):
        ns, s = START_NS + 20_000_000 * k, k / 50
        stamp = t["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
        names = t["std_msgs/msg/Header"].__dataclass_fields__
        head = t["std_msgs/msg/Header"](**({"seq": k} if "seq" in names else {}), stamp=stamp, frame_id="base")
        turn = quaternion(x=np.sin(0.1 * s), y=0.0, z=0.0, w=np.cos(0.1 * s))
        still = np.zeros(9)
        imu = t["sensor_msgs/msg/Imu"](
            header=head,
            orientation=turn,
            orientation_covariance=still,
            angular_velocity=vector(*random.normal(0, 0.1, 3)),
            angular_velocity_covariance=still,
            linear_acceleration=vector(*random.normal((0, 0, 9.8), 0.1)),
            linear_acceleration_covariance=still,
        )
        late = ns + 3_000_000  # the recorder hears of it 3 ms later
        written.append(("/imu/data", "sensor_msgs/msg/Imu", late, imu))
        scan = np.zeros(40)
        written.append(("/own", own, late, t[own](wheel=s, pair=np.array([s, -s], np.float32), scan=scan, name="a")))
        if k % 10 == 0:
            status = t["sensor_msgs/msg/NavSatStatus"]
            fix = t["sensor_msgs/msg/NavSatFix"](
                header=head,
                status=status(**{name: 0 for name in status.__dataclass_fields__ if name in ("status", "service")}),
                latitude=48 + 1e-5 * s,
                longitude=11 + 1e-5 * s,
                altitude=500 + random.normal(0, 0.1),
                position_covariance=still,
                position_covariance_type=0,
            )
            written.append(("/fix", "sensor_msgs/msg/NavSatFix", late, fix))
            pressure = t["sensor_msgs/msg/FluidPressure"](header=head, fluid_pressure=95_000 + s, variance=0.0)
            written.append(("/pressure", "sensor_msgs/msg/FluidPressure", late, pressure))
            twist = t["geometry_msgs/msg/Twist"](linear=vector(s, 0.0, 0.0), angular=vector(0.0, 0.0, np.sin(s)))
            written.append(("/cmd_vel", "geometry_msgs/msg/Twist", late, twist))
            joints = t["sensor_msgs/msg/JointState"](
                header=head, name=["a"] * 4, position=np.arange(4) + s, velocity=np.arange(4) * s, effort=np.zeros(4)
            )
            written.append(("/joints", "sensor_msgs/msg/JointState", late, joints))
            pose = t["geometry_msgs/msg/Pose"](t["geometry_msgs/msg/Point"](s, 2 * s, 0.0), turn)
            turning = t["geometry_msgs/msg/Twist"](vector(1 + s, 0.0, 0.0), vector(0.0, 0.0, np.sin(s)))
            odometry = t["nav_msgs/msg/Odometry"](
                header=head,
                child_frame_id="base",
                pose=t["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36)),
                twist=t["geometry_msgs/msg/TwistWithCovariance"](turning, np.zeros(36)),
            )
            written.append(("/odom", "nav_msgs/msg/Odometry", late, odometry))
            text = t["std_msgs/msg/String"](data="hello")
            written.append(("/chatter", "std_msgs/msg/String", late, text))
    return written


def store_of(ros: int) -> Any:
    store = get_typestore(Stores.ROS1_NOETIC if ros == 1 else Stores.LATEST)
    store.register(get_types_from_msg(OWN, "own_msgs/msg/Own"))
    return store


def bag1(path: Path, compress: bool = False, seconds: float = SECONDS, chunk_bytes: int = 20_000) -> Path:
    store = store_of(1)
    bag = Writer1(path)
    bag.chunk_threshold = chunk_bytes
    if compress:
        bag.set_compression(Writer1.CompressionFormat.LZ4)
    with bag as writer:
        opened: dict[str, Any] = {}
        for topic, kind, ns, message in messages(store, seconds):
            if topic not in opened:
                opened[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(opened[topic], ns, store.serialize_ros1(message, kind))
    return path


def bag2(folder: Path, mcap: bool = False, seconds: float = SECONDS) -> Path:
    """A bag's folder; its one file is `folder/NAME.db3` or `folder/NAME.mcap`."""
    store = store_of(2)
    with Writer2(folder, version=9, storage_plugin=StoragePlugin.MCAP if mcap else StoragePlugin.SQLITE3) as writer:
        opened: dict[str, Any] = {}
        for topic, kind, ns, message in messages(store, seconds):
            if topic not in opened:
                opened[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(opened[topic], ns, store.serialize_cdr(message, kind))
    return folder / f"{folder.name}{'.mcap' if mcap else '.db3'}"


def mcap(path: Path, chunk_bytes: int = 2000, compression: CompressionType = CompressionType.LZ4) -> Path:
    """JSON beside what nobody here can decode, in small chunks."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=chunk_bytes, compression=compression)
        writer.start()
        schema = writer.register_schema("Pose", "jsonschema", b"{}")
        pose = writer.register_channel("/pose", "json", schema)
        image = writer.register_channel("/image", "protobuf", writer.register_schema("foxglove.Image", "protobuf", b""))
        for k in range(200):
            ns = START_NS + 20_000_000 * k
            said = json.dumps({"position": {"x": k / 50, "y": 0.5 * (k % 7)}, "name": "a", "ranges": [1, 2, 3]})
            writer.add_message(pose, ns, said.encode(), ns)
            writer.add_message(image, ns, b"\x00" * 20, ns)
        writer.finish()
    return path
