"""Builds the package, and uses it as a user would: from a fresh environment, in an empty folder.

    python .ci/wheel.py

The wheel holds both packages and what belongs to them; the core installation is small and runs a monitor; with all
extras `sensorfault demo` runs. Versions are those of constraints.txt.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

HOME = Path(__file__).resolve().parent.parent
MOST_MB = 700  # of the core installation
HOLDS = (
    "sensorfault/__init__.py",
    "sensorfault/py.typed",
    "sensorfault/report/page.html",
    "sensorfault/report/page.css",
    "sensorfault/report/page.js",
    "sensorfault_studies/__init__.py",
    "sensorfault_studies/page.html",
    "sensorfault_studies/page.css",
    "sensorfault_studies/page.js",
    ".dist-info/entry_points.txt",
    ".dist-info/licenses/LICENSE",
)
WRITES = ("drive.csv", "drive.truth.json", "car.sensorfault", "report.html")


def main() -> None:
    """Every step; the first that fails ends it."""
    with timed("build sdist and wheel"):
        wheel = build(HOME / "dist")
    check(wheel)
    with tempfile.TemporaryDirectory(prefix="sensorfault-wheel-") as folder:
        python = Path(folder) / "venv" / "bin" / "python"
        with timed("core installation"):
            run(sys.executable, "-m", "venv", "--without-pip", python.parents[1])
            install(python, str(wheel))
        size = size_mb(python)
        print(f"core installation: {size} MB of {MOST_MB}")
        if size > MOST_MB:
            sys.exit(f"The core installation needs {size} MB; move what only some users need to an extra.")
        empty = Path(folder) / "empty"
        empty.mkdir()
        with timed("a monitor on the core installation"):
            run(python, "-I", HOME / "tests" / "core" / "core_only.py", "model.sensorfault", cwd=empty)
        with timed("all extras"):
            install(python, f"sensorfault[all] @ {wheel.as_uri()}", "--no-compile")
        with timed("demo"):
            run(python.with_name("sensorfault"), "demo", cwd=empty)
        missing = [name for name in WRITES if not (empty / "demo" / name).is_file()]
        if missing:
            sys.exit(f"The demo did not write {', '.join(missing)}.")


def build(folder: Path) -> Path:
    """The sdist, and the wheel made of it."""
    shutil.rmtree(folder, ignore_errors=True)
    run(sys.executable, "-m", "build", "--outdir", folder, HOME, stdout=subprocess.DEVNULL)
    (wheel,) = folder.glob("*.whl")
    return wheel


def check(wheel: Path) -> None:
    """What must be in it is, and tests are not."""
    names = zipfile.ZipFile(wheel).namelist()
    missing = [end for end in HOLDS if not any(name == end or name.endswith(end) for name in names)]
    ours = ("sensorfault/", "sensorfault_studies/", "sensorfault-")
    foreign = [name for name in names if not name.startswith(ours) or "tests/" in name or "test_" in name]
    if missing:
        sys.exit(f"{wheel.name} lacks {', '.join(missing)}.")
    if foreign:
        sys.exit(f"{wheel.name} holds what does not belong there: {', '.join(foreign)}.")
    print(f"{wheel.name}: {len(names)} files, {wheel.stat().st_size / 1e6:.1f} MB")


def install(python: Path, *words: str) -> None:
    """By the pip of this environment, into the one of `python`."""
    pip = (sys.executable, "-m", "pip", "--python", python, "install", "-q", "--disable-pip-version-check")
    run(*pip, "-c", HOME / "constraints.txt", *words)


def size_mb(python: Path) -> int:
    """Of all that is installed."""
    (packages,) = python.parents[1].glob("lib/python*/site-packages")
    return int(subprocess.run(["du", "-sm", packages], capture_output=True, check=True).stdout.split()[0])


def run(*command: str | Path, cwd: Path | None = None, stdout: int | None = None) -> None:
    """A command without what would let it find the source."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([str(word) for word in command], cwd=cwd, env=environment, stdout=stdout, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}.")


@contextmanager
def timed(what: str) -> Iterator[None]:
    """Says how long it took."""
    start = perf_counter()
    yield
    print(f"{what}: {perf_counter() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
