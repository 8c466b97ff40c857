"""Read a damaged file: what may come of it is a log or one sentence, soon and without eating the memory."""

import resource
import signal
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

import numpy as np

from fuzz.mutate import mutated
from fuzz.small import SMALL
from logs.small_parts import small_parts
from sensorfault.logs import Log, LogError, guess, read
from sensorfault.logs.parts import read_parts
from sensorfault.logs.readers.formats import format_of, read_tables

LONGEST_S, PATIENCE_S = 2.0, 20.0  # of this process's own time; by the clock, on a machine that has other work
MOST_BYTES = 1 << 30  # more than before: no file here is larger than 100 kB


class TooLong(Exception):
    """A file that is read for longer than LONGEST_S."""


class Fuzzed:
    """One format's small file, and damaged ones made of it in a folder. `seconds`: of the slowest."""

    def __init__(self, title: str, folder: Path) -> None:
        self.title, self.folder = title, folder
        self.sound = SMALL[title](folder)
        self.content = self.sound.read_bytes()
        form = format_of(self.sound)
        self.vehicle = guess(self.sound) if form is not None and form.parts else None
        self.seconds, self.read, self.refused = 0.0, 0, 0

    def damaged(self, number: int) -> bytes:
        """The file damaged in the way of this number."""
        return mutated(self.content, number)

    def one(self, number: int) -> str | None:
        """Damage the file in the way of this number and read it; what is wrong with how that went."""
        self.sound.write_bytes(self.damaged(number))
        start = perf_counter()
        wrong = None
        try:
            with _limits(), warnings.catch_warnings():
                warnings.simplefilter("error")
                self._read(number % 4)
                self.read += 1
        except LogError as error:
            self.refused += 1
            wrong = None if _one_sentence(str(error)) else f"an error that is not one sentence: {str(error)!r}"
        except TooLong:
            wrong = f"longer than {LONGEST_S:g} s"
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            wrong = f"{type(error).__name__}: {error}"
        self.seconds = max(self.seconds, perf_counter() - start)
        self.sound.write_bytes(self.content)
        return wrong and f"{self.title}, damage {number}: {wrong}"

    def _read(self, turn: int) -> None:
        """The reader alone; or all the way to a log, at once or part by part."""
        if turn == 0:
            _check(read(self.sound))
        elif turn == 2 and self.vehicle is not None:
            parts: list[Log] = []
            with small_parts(100):
                read_parts(self.sound, parts.append, self.vehicle)
            _check(*parts)
        else:
            read_tables(self.sound)


def _check(*parts: Log) -> None:
    assert (np.diff(np.concatenate([part.time for part in parts])) > 0).all(), "time does not rise"
    assert not any((part.fresh & ~np.isfinite(part.value)).any() for part in parts), "no value is called new"


def _one_sentence(text: str) -> bool:
    return 0 < len(text) < 3000 and "\n" not in text and text.endswith((".", ")"))


@contextmanager
def _limits() -> Iterator[None]:
    """Time and address space for one file."""

    def stop(_number: int, _frame: object) -> None:
        raise TooLong

    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    clocks = ((signal.ITIMER_PROF, signal.SIGPROF, LONGEST_S), (signal.ITIMER_REAL, signal.SIGALRM, PATIENCE_S))
    earlier = [signal.signal(number, stop) for _, number, _ in clocks]
    for clock, _, longest in clocks:
        signal.setitimer(clock, longest)
    resource.setrlimit(resource.RLIMIT_AS, (used + MOST_BYTES, before[1]))
    try:
        yield
    finally:
        for (clock, number, _), handler in zip(clocks, earlier, strict=True):
            signal.setitimer(clock, 0)
            signal.signal(number, handler)
        resource.setrlimit(resource.RLIMIT_AS, before)
