"""Runs libraries in a process of their own, as a damaged file can make them crash or fill the memory.

The process stays for the next file. Each line of its input is JSON with a file and the place for the result; it answers
with one line: empty, or why the file cannot be read.
"""

import atexit
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from select import select
from typing import Any

import numpy as np

_LONGEST_S, _BYTES_PER_S = 30.0, 1e7
_ENDED = "its sizes and types contradict each other"
_running: dict[str, subprocess.Popen[str]] = {}


@dataclass(frozen=True)
class Loaded:
    """Vectors by table and name, and more about them that fits JSON."""

    vectors: dict[str, dict[str, np.ndarray]]
    result: dict[str, Any] = field(default_factory=dict)

    def save(self, path: str) -> None:
        """Put it where `saved` finds it."""
        names = [(table, name) for table, vectors in self.vectors.items() for name in vectors]
        arrays: dict[str, Any] = {f"v{i}": self.vectors[table][name] for i, (table, name) in enumerate(names)}
        np.savez(path, about=np.array(json.dumps([list(self.vectors), names, self.result])), **arrays)

    @classmethod
    def saved(cls, path: str) -> "Loaded":
        """What `save` has put there."""
        with np.load(path, allow_pickle=False) as found:
            tables, names, result = json.loads(str(found["about"]))
            vectors: dict[str, dict[str, np.ndarray]] = {table: {} for table in tables}
            for i, (table, name) in enumerate(names):
                vectors[table][name] = found[f"v{i}"]
        return cls(vectors, result)


def load_apart(loader: str, path: Path, *more: Any) -> Loaded:
    """The result of `load` of the module of this name for a file; `more`: further arguments that fit JSON.

    Raises:
        ValueError: why it cannot be read.
    """
    with tempfile.TemporaryDirectory(prefix="sensorfault-") as folder:
        into = str(Path(folder) / "vectors.npz")
        answer = _asked(loader, [into, str(path.absolute()), *more], _LONGEST_S + path.stat().st_size / _BYTES_PER_S)
        if answer:
            raise ValueError(answer)
        return Loaded.saved(into)


def reason(error: BaseException) -> str:
    """Why a library cannot read a file, on one line."""
    return (str(error).splitlines() or [""])[0].rstrip(".") or type(error).__name__


def _asked(loader: str, question: list[Any], longest_s: float) -> str:
    """What the other process answers; one that ends or does not answer is replaced."""
    process = _process(loader)
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
        _end(loader)
        return _ENDED
    return answer.rstrip("\n")


def _process(loader: str) -> subprocess.Popen[str]:
    running = _running.get(loader)
    if running is not None and running.poll() is None:
        return running
    _end(loader)
    command = [sys.executable, "-m", "sensorfault.logs.readers.subprocess_serve", loader]
    pipe, quiet = subprocess.PIPE, subprocess.DEVNULL
    _running[loader] = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=quiet, text=True)
    return _running[loader]


def _end(loader: str) -> None:
    process = _running.pop(loader, None)
    if process is not None:
        process.kill()
        process.communicate()


@atexit.register
def _end_all() -> None:
    for loader in list(_running):
        _end(loader)
