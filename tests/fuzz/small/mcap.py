"""MCAP of ROS messages, JSON and protocol buffers."""

from logs import written_foxglove, written_ros

SMALL = {
    "MCAP": lambda folder: written_ros.bag2(folder / "drive", mcap=True, seconds=0.5),
    "MCAP, of JSON": lambda folder: written_ros.mcap(folder / "drive.mcap"),
    "MCAP, of protocol buffers": lambda folder: written_foxglove.mcap(folder / "drive.mcap", count=20),
}
