"""PX4's topics as CSV, as pyulog's ulog2csv names them."""

from pathlib import Path

import numpy as np
import pytest
from pyulog.ulog2csv import convert_ulog2csv

from logs.written_ulog import flight
from sensorfault.logs import LogError, VehicleFile, guess, read


def test_a_folder_of_topics_is_the_flight(tmp_path: Path) -> None:
    path, folder = tmp_path / "flight.ulg", tmp_path / "csv"
    path.write_bytes(flight())
    folder.mkdir()
    convert_ulog2csv(str(path), None, str(folder), ",", None, None)
    (folder / "flight_vehicle_status_0.csv").write_text("timestamp,mode\n1000,1\n2000,1\n")
    found = guess(folder)
    assert VehicleFile.parse(found.to_toml()) == found
    assert "Topics of PX4, one file each; sensors are in flight_sensor_combined_0.csv" in " ".join(found.notes)
    assert "flight_vehicle_status_0.csv" in " ".join(found.notes)
    log, whole = read(folder, found), read(path)
    assert {sensor.name for sensor in log.sensors} == {sensor.name for sensor in whole.sensors}
    assert {(c.path, c.unit) for c in log.channels} == {(c.path, c.unit) for c in whole.channels}
    np.testing.assert_allclose(log.value[:, log.index("gyro.x")], whole.value[:, whole.index("gyro.x")], rtol=1e-6)


def test_an_archive_is_told_from_a_log(tmp_path: Path) -> None:
    (tmp_path / "runs.tar.gz").write_bytes(b"x")
    with pytest.raises(LogError, match="an archive of several files; unpack it"):
        read(tmp_path / "runs.tar.gz")
