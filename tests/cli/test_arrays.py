"""A folder of NumPy arrays through the verbs."""

import json
from pathlib import Path

import numpy as np

import fitted
from cli.conftest import Run


def test_init_detect_and_report_on_a_folder_of_arrays(run: Run) -> None:
    log = fitted.rig().between(end_s=60.0)
    folder = Path("drive")
    folder.mkdir()
    for name, columns in (("gyro", log.of("gyro")), ("accelerometer", log.of("accelerometer"))):
        value = log.value[:, list(columns)]
        if name == "gyro":
            stuck = (log.time >= 45.0) & (log.time < 48.0)
            value[stuck, 1] = value[stuck, 1][0]
        np.save(folder / f"IMU__{name}__t.npy", log.time)
        np.save(folder / f"IMU__{name}__value.npy", value)
    assert run("init", folder).code == 0
    assert 'path = "IMU__gyro__t.npy"' in (folder / "vehicle.toml").read_text()
    said = run("detect", folder, "--method", "pca", "--json", "-", "--report", "page.html")
    events = json.loads(said.out)["events"]
    assert [(event["sensor"], event["channel"], event["kind"]) for event in events] == [("gyro", "y", "frozen")]
    assert "<title>drive</title>" in Path("page.html").read_text()
