"""Whether the files that a command is to write can be written, before it does the work."""

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

MOST = 100_000  # files of a folder of logs that are looked at


def check_outputs(outputs: Sequence[Path | str | None], inputs: Sequence[Path | None]) -> None:
    """Check every output: its folder exists, it is a file or new, it is no input, and no other output.

    Raises:
        LogError: one of them cannot be written.
    """
    from sensorfault.core.files import no_output, same_file
    from sensorfault.logs import LogError

    read = [file for path in inputs if path is not None for file in _files(path)]
    written: list[Path] = []
    for path in (Path(output) for output in outputs if output not in (None, "-")):
        if not path.parent.is_dir():
            raise LogError(f"{path}: there is no folder {path.parent}; make it, or write somewhere else.")
        if reason := no_output(path):
            raise LogError(f"{path} {reason}; give a file to write.")
        if same_file(path, read):
            raise LogError(f"{path} is an input and would be overwritten; give another file to write.")
        if same_file(path, written):
            raise LogError(f"{path} is given for two outputs; give each a file of its own.")
        written.append(path)


def _files(path: Path) -> Iterator[Path]:
    """The file, or those in a folder."""
    yield path
    if path.is_dir():
        yield from islice(path.iterdir(), MOST)
