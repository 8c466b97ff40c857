"""The vectors in a MATLAB file, by SciPy. Also a program of its own, which imports nothing of the package.

As a program it is told on each line of its input, as JSON, a file and where to put what it found, and answers with a
line: nothing, or why the file cannot be read.
"""

import json
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

Vectors = dict[str, dict[str, np.ndarray]]  # of each structure, by field; "" has those that stand in none
_NUMBERS = "biuf"  # numpy's letters for truths, whole numbers and floats
_MOST_BYTES = 1 << 28  # a damaged size must not fill the memory


def load(path: str) -> Vectors:
    """The numbers of every structure. Functions and objects are left alone.

    Raises:
        NotImplementedError: version 7.3 (HDF5).
        Exception: of any kind, if the file is damaged.
    """
    from scipy.io import loadmat  # lazily: half a second that only this format needs

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = loadmat(path, squeeze_me=True, struct_as_record=False)
    found = {name: one for name, one in found.items() if not name.startswith("__")}
    structures = {name: vars(one) for name, one in found.items() if hasattr(one, "_fieldnames")}
    structures[""] = {name: one for name, one in found.items() if name not in structures}
    return {name: _vectors(fields) for name, fields in structures.items()}


def _vectors(fields: dict[str, Any]) -> dict[str, np.ndarray]:
    arrays = {name: np.asarray(one) for name, one in fields.items() if not name.startswith("_")}
    return {name: one for name, one in arrays.items() if one.ndim == 1 and one.dtype.kind in _NUMBERS}


def save(vectors: Vectors, path: str) -> None:
    """Put them where `saved` finds them."""
    names = [(structure, field) for structure, fields in vectors.items() for field in fields]
    arrays: dict[str, Any] = {f"v{i}": vectors[structure][field] for i, (structure, field) in enumerate(names)}
    np.savez(path, names=np.array(json.dumps([list(vectors), names])), **arrays)


def saved(path: str) -> Vectors:
    """What `save` has put there."""
    with np.load(path, allow_pickle=False) as found:
        structures, names = json.loads(str(found["names"]))
        vectors: Vectors = {structure: {} for structure in structures}
        for i, (structure, field) in enumerate(names):
            vectors[structure][field] = found[f"v{i}"]
    return vectors


def reason(error: BaseException) -> str:
    """Why a file cannot be read, on one line."""
    return (str(error).splitlines() or [type(error).__name__])[0].rstrip(".") or type(error).__name__


def _serve() -> None:
    limit = _limit()
    for line in sys.stdin:
        path, into = json.loads(line)
        limit(Path(path).stat().st_size)
        try:
            save(load(path), into)
            answer = ""
        except NotImplementedError:
            answer = "7.3"
        except BaseException as error:
            answer = reason(error)
        print(answer, flush=True)


def _limit() -> Any:
    """What keeps the memory within bounds, where the system has means for that."""
    try:
        import resource

        import scipy.io  # noqa: F401

        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    except (ImportError, OSError):
        return lambda size: None
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    return lambda size: resource.setrlimit(resource.RLIMIT_AS, (used + 8 * size + _MOST_BYTES, hard))


if __name__ == "__main__":
    _serve()
