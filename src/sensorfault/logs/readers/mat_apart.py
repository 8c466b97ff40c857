"""MATLAB files are read in another process: some damage makes SciPy end the interpreter, or fill the memory.

What is packed (version 7, MATLAB's default) carries checksums and is read in this one.
"""

import atexit
import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from select import select

from sensorfault.logs.readers import mat_load
from sensorfault.logs.readers.mat_load import Vectors

_HEAD, _TAG = 128, struct.Struct("<II")
_PACKED = 15  # miCOMPRESSED
_LONGEST_S, _BYTES_PER_S = 30.0, 1e7
_running: list[subprocess.Popen[str]] = []


def load(path: Path) -> Vectors:
    """The vectors in a MATLAB file.

    Raises:
        NotImplementedError: version 7.3 (HDF5).
        ValueError: why it cannot be read.
    """
    if _all_packed(path):
        return mat_load.load(str(path))
    with tempfile.TemporaryDirectory(prefix="sensorfault-") as folder:
        into = str(Path(folder) / "vectors.npz")
        answer = _asked([str(path.absolute()), into], _LONGEST_S + path.stat().st_size / _BYTES_PER_S)
        if answer == "7.3":
            raise NotImplementedError
        if answer:
            raise ValueError(answer)
        return mat_load.saved(into)


def _asked(question: list[str], longest_s: float) -> str:
    """What the other process answers; one that ends or does not answer is replaced."""
    process = _process()
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(question) + "\n")
        process.stdin.flush()
        ready, _, _ = select([process.stdout], [], [], longest_s)
        answer = process.stdout.readline() if ready else ""
    except OSError:
        answer = ""
    if not answer:
        _end()
        return "its sizes and types contradict each other"
    return answer.rstrip("\n")


def _all_packed(path: Path) -> bool:
    """Whether each variable of the file is packed."""
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(_HEAD)[126:] != b"IM":
            return False
        at = _HEAD
        while at + _TAG.size <= size:
            file.seek(at)
            kind, length = _TAG.unpack(file.read(_TAG.size))
            if kind != _PACKED:
                return False
            at += _TAG.size + length
    return at == size


def _process() -> subprocess.Popen[str]:
    """It lives on for the next file: SciPy takes half a second to come."""
    if _running and _running[0].poll() is None:
        return _running[0]
    _end()
    command = [sys.executable, "-P", str(Path(mat_load.__file__))]  # -P: its folder has a csv.py
    pipe, quiet = subprocess.PIPE, subprocess.DEVNULL
    _running.append(subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=quiet, text=True))
    return _running[0]


@atexit.register
def _end() -> None:
    while _running:
        process = _running.pop()
        process.kill()
        process.communicate()
