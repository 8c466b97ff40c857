"""Libraries that are not installed with the package, as few need them."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sensorfault.logs.table import LogError


@contextmanager
def extra(path: Path, name: str) -> Iterator[None]:
    """Inside, imports may fail for want of the extra of this name; and what the libraries warn of goes nowhere.

    Raises:
        LogError: what to install to read the file.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield
        except ImportError as error:
            raise missing(path, error.name or "a library", name) from None


def missing(path: Path, library: str, name: str) -> LogError:
    """What to install to read the file."""
    return LogError(f"{path}: reading it needs {library}; run `pip install 'sensorfault[{name}]'`.")
