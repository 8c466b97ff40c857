"""The process that subprocess_reader starts: `python -m sensorfault.logs.readers.subprocess_serve mat_load`."""

import json
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from sensorfault.logs.readers.subprocess_reader import reason

_LIBRARIES = {"mat_load": "scipy.io", "mat73_load": "h5py", "mdf_load": "asammdf"}
_TIMES, _MOST_BYTES = 30, 1 << 28  # a damaged size must not fill the memory: times the file's, and so much more


def main() -> None:
    """Load the files that are named until nobody names one any more."""
    load = import_module(f"sensorfault.logs.readers.{sys.argv[1]}").load
    import_module(_LIBRARIES[sys.argv[1]])  # before the memory is bounded
    answers, sys.stdout = sys.stdout, sys.stderr
    limit = _limit()
    for line in sys.stdin:
        into, path, *more = json.loads(line)
        limit(Path(path).stat().st_size)
        try:
            load(path, *more).save(into)
            answer = ""
        except BaseException as error:
            answer = reason(error)
        print(answer, file=answers, flush=True)


def _limit() -> Callable[[int], None]:
    """What keeps the memory within bounds, where the system has means for that."""
    try:
        import resource

        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    except (ImportError, OSError):
        return lambda size: None
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    return lambda size: resource.setrlimit(resource.RLIMIT_AS, (used + _TIMES * size + _MOST_BYTES, hard))


if __name__ == "__main__":
    main()
