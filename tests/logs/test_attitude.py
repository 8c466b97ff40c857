"""Angles out of an autopilot's quaternion."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from sensorfault.logs import read


def test_angles_stand_beside_the_quaternion(tmp_path: Path) -> None:
    random = np.random.default_rng(6)
    angles = random.uniform([-1, -1, -3], [1, 1, 3], (60, 3)).cumsum(axis=0) * 0.02  # roll, pitch, yaw
    x, y, z, w = Rotation.from_euler("ZYX", angles[:, ::-1]).as_quat().T
    path = tmp_path / "vehicle_attitude.csv"
    rows = np.column_stack([20_000 * np.arange(60), w, x, y, z])
    np.savetxt(path, rows, delimiter=",", header="timestamp,q[0],q[1],q[2],q[3]", comments="", fmt="%.12g")
    log = read(path)
    found = log.value[:, [log.index(f"attitude.{name}") for name in ("roll", "pitch", "yaw")]]
    np.testing.assert_allclose(found, angles, atol=1e-9)
    np.testing.assert_allclose(log.value[:, log.index("quaternion.0")], w, atol=1e-9)
