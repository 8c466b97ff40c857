"""Files appear whole or not at all, and never in place of what a command reads."""

import errno
import os
import re
import stat
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def appearing(path: Path) -> Iterator[Path]:
    """A temporary path beside `path` to write to; it takes the name `path` when the block ends without an error.

    A symbolic link stays, and the file it points to is replaced.

    Raises:
        OSError: the folder does not exist or cannot be written to, or `path` is a folder, a device or a pipe; the error
            names `path`.
    """
    with _called(path):
        target = Path(os.path.realpath(path))
        if reason := no_output(target):
            raise OSError(errno.EISDIR if target.is_dir() else errno.EINVAL, _spoken(target, reason), str(path))
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=target.suffix)
    os.close(handle)
    temporary = Path(name)
    try:
        with _called(path):
            yield temporary
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _spoken(path: Path, reason: str) -> str:
    return os.strerror(errno.EISDIR) if path.is_dir() else reason


def no_output(path: Path) -> str:
    """Why nothing may be written there; empty if it may: a file that is there already, or a new one."""
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return ""
    except OSError as error:
        return error.strerror or "cannot be written"
    if stat.S_ISDIR(mode):
        return "is a folder"
    return "" if stat.S_ISREG(mode) else "is a device or a pipe"


def no_input(path: Path) -> str:
    """Why nothing may be read from there; empty if it may: a file or a folder."""
    try:
        mode = path.stat().st_mode
    except OSError as error:
        return error.strerror or "cannot be read"
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        return "is a device or a pipe, not a file"
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return "has a name that is no UTF-8; rename it"
    return ""


def same_file(path: Path, others: Iterable[Path]) -> bool:
    """Whether a path is one of the others under any name: links are followed."""
    real = os.path.realpath(path)
    for other in others:
        if os.path.realpath(other) == real:
            return True
        try:
            if os.path.samefile(path, other):
                return True
        except OSError:
            continue
    return False


def safe_name(name: str) -> str:
    """A name of a log or a vehicle as the name of a file here: nothing in it leads to another folder."""
    return re.sub(r"[^\w.+-]+", "_", name).lstrip(".") or "log"


@contextmanager
def _called(path: Path) -> Iterator[None]:
    """Errors name the path that the caller knows, not the temporary one."""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            error.filename, error.filename2 = str(path), None
        raise
