"""ROS bags."""

from logs import written_ros

SMALL = {
    "ROS 1 bag": lambda folder: written_ros.bag1(folder / "drive.bag", seconds=0.5),
    "ROS 1 bag, in lz4": lambda folder: written_ros.bag1(folder / "drive.bag", compress=True, seconds=0.5),
    "ROS 2 bag": lambda folder: written_ros.bag2(folder / "drive", seconds=0.5),
}
