"""KITTI's raw OXTS data: `timestamps.txt`, and in `data` beside it a file of thirty numbers for each time.

Source: Geiger et al. 2013, "Vision meets robotics: the KITTI dataset", development kit, dataformat.txt.
"""

import re
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.readers.format import Format, one_table
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

# What is the same in other axes has no name here and is left out.
_COLUMNS = (
    "latitude [deg]", "longitude [deg]", "altitude [m]", "roll [rad]", "pitch [rad]", "yaw [rad]",
    "velocity_north [m/s]", "velocity_east [m/s]", "", "", "velocity_up [m/s]",
    "accelerometer_x [m/s^2]", "accelerometer_y [m/s^2]", "accelerometer_z [m/s^2]", "", "", "",
    "gyro_x [rad/s]", "gyro_y [rad/s]", "gyro_z [rad/s]", "", "", "",
    "pos_accuracy", "vel_accuracy", "navstat", "numsats", "posmode", "velmode", "orimode",
)  # fmt: skip


_STAMP = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d(\.\d{1,9})?")


def read_kitti(path: Path) -> Source:
    """One table on Unix time.

    Raises:
        LogError: no data beside the times, or another number of files than of times, or a file of other numbers.
    """
    files = sorted((path.parent / "data").glob("*.txt"))
    lines = path.read_text("utf-8", "replace").split("\n")
    stamps = [line.strip() for line in lines if line.strip()]
    if len(files) != len(stamps):
        raise LogError(f"{path}: {len(stamps)} times, but {len(files)} files in the folder data beside it; copy all.")
    odd = next((number for number, one in enumerate(stamps, 1) if not _STAMP.fullmatch(one)), None)
    if odd is not None:
        raise LogError(f"{path}: time {odd} is no date and clock as 2011-09-26 13:02:25.964; correct it.")
    try:
        time = np.array(stamps, "datetime64[ns]").astype(np.int64) / 1e9
        rows = np.array(
            [np.array(file.read_text("utf-8", "replace").split()[: len(_COLUMNS)], float) for file in files]
        )
    except ValueError as error:
        raise LogError(f"{path}: a time or a number beside it cannot be read ({error}); download it again.") from None
    if rows.ndim != 2 or rows.shape[1] != len(_COLUMNS):
        raise LogError(f"{path}: the files in data beside it have no {len(_COLUMNS)} numbers; download them again.")
    columns = {name: rows[:, i] for i, name in enumerate(_COLUMNS) if name}
    return Source(path, pl.DataFrame({"time": time, **columns}), "time", "s")


def looks_kitti(head: bytes) -> bool:
    """Whether a file begins with such a time."""
    first = head.split(b"\n")[0].strip().decode("utf-8", "replace")
    return _STAMP.fullmatch(first) is not None and "." in first


FORMAT = Format("KITTI OXTS", ("timestamps.txt",), one_table(read_kitti), looks_kitti, priority=2)
