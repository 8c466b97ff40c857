"""Whether the files that a command is to write can be written, before it does the work."""

from collections.abc import Sequence
from pathlib import Path


def check_outputs(outputs: Sequence[Path | str | None], inputs: Sequence[Path | None]) -> None:
    """Check every output: its folder exists, it is not a folder itself, and it is none of the inputs.

    Raises:
        LogError: one of them cannot be written.
    """
    from sensorfault.logs import LogError

    read = {path.resolve() for path in inputs if path is not None}
    for path in (Path(output) for output in outputs if output not in (None, "-")):
        if not path.parent.is_dir():
            raise LogError(f"{path}: there is no folder {path.parent}; make it, or write somewhere else.")
        if path.is_dir():
            raise LogError(f"{path} is a folder; give a file to write.")
        if path.resolve() in read:
            raise LogError(f"{path} is an input and would be overwritten; give another file to write.")
