"""NumPy arrays: times in one file, values in another beside it, as comma2k19 keeps its logs.

`NAME__t.npy` holds the times [s] of `NAME__value.npy`; `_t` and `_value`, or `NAME.t.npy` beside `NAME.npy`, will do.
`NAME_times.npy` holds the times of every `NAME_*.npy` that has none of its own. A table is called by its times' file.
"""

import re
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.readers.format import Format, one_table
from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.npy_columns import columns_of
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_TIMES = re.compile(r"(__t|_t|\.t|_times)$")
_VALUES = re.compile(r"(__value|_value|\.value)$")
_NUMBERS = "biuf"  # numpy's letters for truths, whole numbers and floats


def read_npy(path: Path) -> Source:
    """One table: the times, and the columns of all values that go with them. Nothing is ever unpickled.

    Raises:
        LogError: no times or no values beside it, a file that is cut off or no array of numbers, more than two axes, or
            another number of values than of times.
    """
    if path != called_by(path):
        path = called_by(path)
    elif not _TIMES.search(path.stem):
        name = name_of(path)
        raise LogError(f"{path}: there are no times beside these values; save them as {name}__t.npy, in seconds.")
    values = _values_of(path)
    if not values:
        name = name_of(path)
        raise LogError(f"{path}: there are no values beside these times; save them as {name}__value.npy.")
    return _joined(path, {_word(file, path, len(values)): file for file in values}, path.stem)


def _joined(path: Path, values: dict[str, Path], clock: str) -> Source:
    """One table of the times in a file, and the values in others, by what they measure."""
    time = _array(path)
    if time.ndim != 1:
        raise LogError(f"{path}: times of shape {time.shape}; save one time a row, in seconds.")
    columns = {clock: time}
    for word, file in values.items():
        value = _array(file)
        if value.ndim not in (1, 2):
            raise LogError(f"{file}: an array of {value.ndim} axes is not a table; save rows, or rows and columns.")
        if len(value) != len(time):
            raise LogError(f"{file}: {len(value)} rows, but {path.name} has {len(time)}; save one row for each time.")
        width = None if value.ndim == 1 else value.shape[1]
        for i, name in enumerate(columns_of(word, width, alone=len(values) == 1)):
            columns[name] = value if value.ndim == 1 else value[:, i]
    frame = pl.DataFrame({name: pl.Series(name, native(column), nan_to_null=False) for name, column in columns.items()})
    return Source(path if clock != "time" else next(iter(values.values())), frame, time=clock)


def called_by(path: Path) -> Path:
    """The file that the table of an array is called by: its times, or itself where there are none."""
    if _TIMES.search(path.stem) and _values_of(path):
        return path
    return _time_of(path) or path


def name_of(path: Path) -> str:
    """What a table's file is called without saying that it holds times."""
    return _VALUES.sub("", _TIMES.sub("", path.stem))


def _time_of(path: Path) -> Path | None:
    """The times of these values."""
    name = _VALUES.sub("", path.stem)
    words = name.split("_")
    shared = ["_".join(words[:count]) + "_times" for count in range(len(words) - 1, 0, -1)]
    for stem in (f"{name}__t", f"{name}_t", f"{name}.t", *shared):
        file = path.with_name(f"{stem}.npy")
        if file.is_file() and file != path:
            return file
    return None


def _values_of(path: Path) -> list[Path]:
    """The values at these times, by name."""
    return sorted(file for file in path.parent.glob("*.npy") if file != path and _time_of(file) == path)


def _word(file: Path, times: Path, count: int) -> str:
    """What an array measures, by the last part of its name; of several arrays, what its name has beyond the others'."""
    name = _VALUES.sub("", file.stem)
    if count > 1 and name.startswith(name_of(times)):
        name = name.removeprefix(name_of(times)).strip("_.") or name
    return name.split("__")[-1]


def _array(path: Path) -> np.ndarray:
    """The array in a file, mapped, not read."""
    try:
        array: np.ndarray = np.lib.format.open_memmap(path, mode="r")  # refuses objects: nothing is unpickled
    except Exception as error:  # a damaged header fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        reason = (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
        raise LogError(f"{path}: not a whole array of numbers ({reason}); save it again with numpy.save.") from None
    if array.dtype.kind not in _NUMBERS or not array.ndim or not array.size:
        raise LogError(f"{path}: not a table of numbers; save one with numpy.save: rows, or rows and columns.")
    return array


def read_value(path: Path) -> Source:
    """comma2k19's own layout: a folder for each quantity, with the arrays `t` and `value`.

    Raises:
        LogError: as `read_npy`.
    """
    times = path.with_name("t")
    if not times.is_file():
        raise LogError(f"{path}: there is no file 't' with the times beside these values; copy both.")
    return _joined(times, {path.parent.name: path}, "time")


FORMATS = (
    Format("NumPy arrays", ("*.npy",), one_table(read_npy), leader=called_by),
    Format("comma2k19", ("value",), one_table(read_value)),
)
