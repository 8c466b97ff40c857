"""MATLAB, old and new."""

from pathlib import Path

from scipy.io import savemat

from fuzz.writing import COLUMNS
from logs import written_mat73


def mat(folder: Path) -> Path:
    path = folder / "flight.mat"
    savemat(path, {"flight_data": {name: value[:, None] for name, value in COLUMNS.items()}})
    return path


def mat73(folder: Path, packed: bool = True) -> Path:
    return written_mat73.save(folder / "flight.mat", {"flight_data": COLUMNS}, packed=packed)


SMALL = {
    "MATLAB": mat,
    "MATLAB, version 7.3": mat73,
    "MATLAB, version 7.3, not packed": lambda folder: mat73(folder, packed=False),
}
