"""A program that needs the core installation only: it detects, and it says what everything else needs.

    python core_only.py MODEL [LIBRARY ...]

It writes to the folder that it runs in. MODEL: where the model of `healthy()` is, or will be put if there is none.
LIBRARY: imports that are made to fail.
"""

import contextlib
import io
import sys
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # sensorfault is imported when libraries are blocked, not before
    from sensorfault.logs import Log

VERBS = (
    ("demo",),
    ("init", "x.csv"),
    ("info", "x.csv"),
    ("fit", "x.csv"),
    ("detect", "x.csv"),
    ("inject", "x.csv", "--fault", "offset:gyro:1:1:1", "--out", "y.csv"),
    ("evaluate", "x.csv"),
    ("report", "x.csv"),
    ("reproduce", "min2021"),
)
FAULT_S = 20.0, 25.0


class Blocked:
    """A finder of modules that finds these not to be installed."""

    def __init__(self, libraries: set[str]) -> None:
        self.libraries = libraries

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if name.partition(".")[0] in self.libraries:
            raise ModuleNotFoundError(f"No module named '{name}'", name=name)
        return None


def healthy(seed: int) -> "Log":
    """60 s at 50 Hz of a gyroscope and an accelerometer that share three causes."""
    import sensorfault as sf
    from sensorfault.logs import Channel, Sensor

    rng = np.random.default_rng(seed)
    time = np.arange(3000) / 50
    causes = np.sin(np.outer(time, (0.9, 1.7, 2.3)) + rng.uniform(0, 6, 3))
    mixing = np.random.default_rng(7).uniform(-1, 1, (3, 6))
    value = causes @ mixing + rng.uniform(-0.1, 0.1, (3000, 6))
    channels = tuple(Channel(axis, sensor) for sensor in ("gyro", "accelerometer") for axis in "xyz")
    sensors = (Sensor("gyro", 0.02), Sensor("accelerometer", 0.02))
    return sf.Log(time, value, np.ones(value.shape, bool), channels, sensors)


def detects(path: Path) -> None:
    """Load, detect and run live: an offset of gyro.z is found both ways."""
    import sensorfault as sf

    model, log = sf.load(path), healthy(1)
    log.value[(log.time >= FAULT_S[0]) & (log.time < FAULT_S[1]), 2] += 1.0
    events = sf.detect(model, log).events
    assert [(event.sensor, event.channel) for event in events] == [("gyro", "z")], events
    live = sf.Live(model)
    verdicts = np.array([live.push(time, row).sample for time, row in zip(log.time, log.value, strict=True)])
    found = log.time[verdicts == sf.FAULT]
    assert len(live.events) == 1, live.events
    assert np.all((found >= FAULT_S[0]) & (found < FAULT_S[1] + 1)), found
    print("detect and Live:", live.events[0].channel)


def run(*words: str) -> tuple[int | None, str]:
    """A verb's exit code, and what it said on stderr."""
    from sensorfault.cli import main

    sys.argv, said, code = ["sensorfault", *words], io.StringIO(), None
    with contextlib.redirect_stderr(said):
        try:
            main()
        except SystemExit as end:
            code = int(end.code or 0)
    return code, said.getvalue().strip()


def answers() -> None:
    """Whatever needs an extra says so."""
    import sensorfault as sf
    from sensorfault.core.extras import MissingLibrary

    for name in sf.__all__:
        getattr(sf, name)
    try:
        sf.read("x.csv")
    except MissingLibrary as error:
        print("read:", error)
    Path("x.csv").write_text("time,gyro_x\n0,1\n1,2\n")
    for words in VERBS:
        code, said = run(*words)
        print(f"{words[0]}: {code} {said}")
        assert code == 2, words
        assert "; run `pip install 'sensorfault[" in said, said
        assert "\n" not in said, said


def main(path: Path, blocked: set[str]) -> None:
    """Monitor first, without even what fits; then all the rest."""
    finder = Blocked(blocked | {"optax"} if path.exists() else blocked)
    sys.meta_path.insert(0, finder)
    if not path.exists():
        import sensorfault as sf

        sf.save(sf.fit(healthy(0), "linear-conditioning"), path)
    detects(path)
    finder.libraries = blocked
    answers()


if __name__ == "__main__":
    main(Path(sys.argv[1]), set(sys.argv[2:]))
