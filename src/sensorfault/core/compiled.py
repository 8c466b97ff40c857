"""Compiled programs on disk, so that no user waits for the same compilation twice.

The folder is the user's own (mode 0700), because it holds executable code. `SENSORFAULT_CACHE=off` switches it off,
`SENSORFAULT_CACHE=FOLDER` puts it elsewhere. This module imports no JAX; `_jax` connects the two.
"""

import hashlib
import os
import platform
import stat
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

VARIABLE = "SENSORFAULT_CACHE"
MOST_BYTES = 256 << 20  # then the entries unused for longest go, down to KEPT of it
KEPT = 0.8
OWN = "sensorfault-compiled"  # inside a folder that the user chose, whose rights are not ours to change
_ENDING = ".xla"
_DIGEST = hashlib.sha256().digest_size


def folder() -> Path | None:
    """Where the programs lie; None if the user switched the cache off."""
    chosen = os.environ.get(VARIABLE, "")
    if chosen.lower() in ("off", "0", "no", "false"):
        return None
    if chosen and chosen.lower() not in ("on", "1", "yes", "true"):
        return Path(chosen).expanduser() / OWN
    from platformdirs import user_cache_path

    return user_cache_path("sensorfault") / "compiled"


def machine() -> str:
    """What a program compiled here needs to run: the processor's type and features, as one short name."""
    features = ""
    with suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").split("\n\n", 1)[0].splitlines()
        features = "\n".join(
            line for line in lines if line.split("\t")[0].strip() in ("flags", "Features", "model name")
        )
    words = f"{platform.system()} {platform.machine()} {platform.processor()} {features}"
    return hashlib.sha256(words.encode()).hexdigest()[:16]


class Unusable(OSError):
    """The folder cannot hold programs safely. One sentence says why."""


@dataclass(frozen=True)
class Programs:
    """The programs in a folder, each under its key, with a digest; at most `most_bytes` of them.

    Nothing here raises when used: an entry that is damaged, foreign or unreadable is dropped, and what cannot be
    written is not kept.
    """

    home: Path
    most_bytes: int = MOST_BYTES

    def prepare(self) -> None:
        """Make the folder, for this user alone.

        Raises:
            Unusable: it cannot be made, is a link, belongs to somebody else, or others may write to it.
        """
        try:
            self.home.mkdir(mode=0o700, parents=True, exist_ok=True)
            found = self.home.lstat()
            if hasattr(os, "getuid"):
                if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid():
                    raise Unusable(f"{self.home} is a link or belongs to another user; remove it, or set {VARIABLE}.")
                if found.st_mode & 0o077:
                    self.home.chmod(0o700)
        except Unusable:
            raise
        except OSError as error:
            raise Unusable(f"{self.home} cannot be used ({error.strerror or error}); set {VARIABLE}.") from None

    def get(self, key: str) -> bytes | None:
        """The program of that key, or None."""
        path = self._path(key)
        try:
            content = path.read_bytes()
        except OSError:
            return None
        program = content[_DIGEST:]
        if content[:_DIGEST] != _digest(key, program):
            with suppress(OSError):
                path.unlink()
            return None
        with suppress(OSError):
            os.utime(path)
        return program

    def put(self, key: str, program: bytes) -> None:
        """Keep a program; it appears whole or not at all."""
        if len(program) > self.most_bytes:
            return
        with suppress(OSError):
            handle, name = tempfile.mkstemp(dir=self.home, suffix=f"{_ENDING}.part")  # mode 0600
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(_digest(key, program) + program)
                os.replace(name, self._path(key))
            except BaseException:
                Path(name).unlink(missing_ok=True)
                raise
            self._bound()

    def sizes(self) -> dict[Path, tuple[float, int]]:
        """When each entry was last used [s since 1970], and its size [bytes]."""
        found: dict[Path, tuple[float, int]] = {}
        with suppress(OSError):
            for entry in os.scandir(self.home):
                with suppress(OSError):
                    if entry.name.endswith((_ENDING, f"{_ENDING}.part")):
                        about = entry.stat(follow_symlinks=False)
                        found[Path(entry.path)] = about.st_mtime, about.st_size
        return found

    def clear(self) -> int:
        """Remove every entry; how many there were."""
        entries = self.sizes()
        for path in entries:
            with suppress(OSError):
                path.unlink()
        return len(entries)

    def _path(self, key: str) -> Path:
        return self.home / (hashlib.sha256(key.encode()).hexdigest() + _ENDING)

    def _bound(self) -> None:
        entries = self.sizes()
        total = sum(size for _, size in entries.values())
        if total <= self.most_bytes:
            return
        for path, (_, size) in sorted(entries.items(), key=lambda one: one[1][0]):
            with suppress(OSError):
                path.unlink()
            total -= size
            if total <= KEPT * self.most_bytes:
                return


def _digest(key: str, program: bytes) -> bytes:
    return hashlib.sha256(key.encode() + b"\0" + program).digest()
