"""A drive in Foxglove's own schemas, as protocol buffers, by Foxglove's own writer."""

from pathlib import Path

import foxglove
import numpy as np
from foxglove import channels, messages

START_NS = 1_700_000_000 * 10**9


def mcap(path: Path, count: int = 100) -> Path:
    """At 50 Hz; the recorder hears of it 3 ms later. The fix has no velocity in its first half."""
    context = foxglove.Context()
    with foxglove.open_mcap(path, allow_overwrite=True, context=context):
        fix = channels.LocationFixChannel("/gps", context=context)
        odometry = channels.OdometryChannel("/odom", context=context)
        joints = channels.JointStatesChannel("/joints", context=context)
        for k in range(count):
            ns, s = START_NS + 20_000_000 * k, k / 50
            at = messages.Timestamp(sec=ns // 10**9, nsec=ns % 10**9)
            late = ns + 3_000_000
            moving = messages.Vector3(x=s, y=-s, z=0.1) if k >= count // 2 else None
            place = {"latitude": 48 + 1e-5 * s, "longitude": 11 - 1e-5 * s, "altitude": 500 + k % 7 / 10}
            fix.log(messages.LocationFix(timestamp=at, frame_id="a", velocity=moving, **place), log_time=late)
            turn = messages.Quaternion(x=np.sin(0.1 * s), y=0.0, z=0.0, w=np.cos(0.1 * s))
            odometry.log(
                messages.Odometry(
                    timestamp=at,
                    pose=messages.Pose(position=messages.Vector3(x=s, y=2 * s, z=0.0), orientation=turn),
                    linear_velocity=messages.Vector3(x=1 + s, y=0.0, z=0.0),
                    angular_velocity=messages.Vector3(x=0.0, y=0.0, z=np.sin(s)),
                ),
                log_time=late,
            )
            two = [
                messages.JointState(name="a", position=s),
                messages.JointState(name="b", position=-s, velocity=-1 - s),
            ]
            joints.log(messages.JointStates(timestamp=at, joints=two), log_time=late)
    return path
