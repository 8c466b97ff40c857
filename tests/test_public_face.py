"""What `import sensorfault as sf` offers: names, types seen from outside, an example that runs, plain refusals."""

import ast
import doctest
import json
import os
import re
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import fitted
import sensorfault as sf
from cli.conftest import write_csv
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject

SOURCE = Path(sf.__file__).parent
STUB = SOURCE / "__init__.pyi"


def imports() -> dict[str, str]:
    """Name -> module, as a type checker reads the stub: only `import X as X` is passed on."""
    lines = [line for line in ast.parse(STUB.read_text()).body if isinstance(line, ast.ImportFrom)]
    return {alias.name: str(line.module) for line in lines for alias in line.names if alias.asname == alias.name}


def test_what_types_see_is_what_runs() -> None:
    """One list serves both; here each name in it is looked up where the stub says."""
    seen = imports()
    assert set(sf.__all__) == set(seen)
    assert len(seen) >= 26
    for name, module in seen.items():
        assert getattr(sf, name) is getattr(import_module(module), name)


def test_dir_shows_the_public_names_and_nothing_else() -> None:
    shown = [name for name in dir(sf) if not name.startswith("__")]
    assert shown == sorted(sf.__all__)
    assert "__version__" in dir(sf)
    assert {"read", "fit", "detect", "plot", "Live", "Fault"} <= set(shown)


def test_the_version_is_the_installed_one() -> None:
    assert sf.__version__ == version("sensorfault")
    with pytest.raises(AttributeError, match=r"has no 'nonsense'; it has .*read"):
        sf.nonsense  # noqa: B018


USER = """
import sensorfault as sf

log = sf.read("drive.csv")
model = sf.fit(log, "pca")
found = sf.detect(model, log)
reveal_type(sf.read)
reveal_type(model)
reveal_type(found.events)
reveal_type(sf.Live(model).push)
sf.detect(log, model)
"""


def test_mypy_sees_the_types_from_outside(tmp_path: Path) -> None:
    """A user's script far from the sources; without py.typed every type would be Any."""
    (tmp_path / "user.py").write_text(USER)
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "user.py"]
    environment = os.environ | {"PYTHONPATH": str(SOURCE.parent)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert not done.stderr
    revealed = dict(re.findall(r'user\.py:(\d+): note: Revealed type is "(.*)"', done.stdout))
    assert revealed["7"].startswith("def (path: ")
    assert revealed["7"].endswith("-> sensorfault.logs.table.Log")
    assert revealed["8"] == "sensorfault.runtime.model.Model"
    assert revealed["9"] == "tuple[sensorfault.events.event.Event, ...]"
    assert revealed["10"].startswith("def (time: float, value: Any")
    assert "sensorfault.runtime.runners.StepResult" in revealed["10"]
    errors = re.findall(r"user\.py:(\d+): error: (.*)", done.stdout)
    assert errors
    assert all(line == "11" and "incompatible type" in error for line, error in errors), done.stdout
    assert (SOURCE.parent / "sensorfault_studies" / "py.typed").is_file()


def test_the_example_of_the_docstring_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a drive of 150 s whose gyro is stuck for three of the last thirty."""
    healthy = fitted.rig().between(end_s=150.0)
    log = inject(healthy, [Fault("frozen", "gyro", "y", 130.0, 3.0)]).log
    write_csv(tmp_path / "drive.csv", log)
    monkeypatch.chdir(tmp_path)
    examples = doctest.DocTestParser().get_examples(str(sf.__doc__))
    assert len(examples) >= 10
    names: dict[str, object] = {"values": log.value[6001].tolist()}
    for example in examples:
        exec(compile(example.source, "<docstring>", "single"), names)
    found = names["found"]
    assert isinstance(found, sf.Detection)
    assert [(event.where, event.kind) for event in found.events] == [("gyro.y", "frozen")]
    said = re.search(r"print\(event\)  # (.*)", str(sf.__doc__))
    assert said is not None
    assert str(found.events[0]).startswith("2:10.")
    assert re.sub(r"[\d.]+", "N", str(found.events[0])) == re.sub(r"[\d.]+", "N", said[1])


WRONG = {
    "sf.fit(None)": ("fit: log is None", "give a Log"),
    "sf.fit('drive.csv')": ("fit: log is a str ('drive.csv')", "give a Log, as sf.read returns it"),
    "sf.fit(log, method=3)": ("fit: method is an int (3)", "sf.METHODS"),
    "sf.detect(log, model)": ("detect: model is a Log", "give a Model, as sf.fit or sf.load returns it"),
    "sf.detect(found, log)": ("detect: model is a Detection", "give a Model"),
    "sf.detect(model, 'drive.csv')": ("detect: log is a str ('drive.csv')", "give a Log"),
    "sf.detect(model, sf.inject(log, [fault]))": ("detect: log is an Injected", "give its .log"),
    "sf.save(found, 'model')": ("save: model is a Detection", "give a Model"),
    "sf.save('model', model)": ("save: model is a str ('model')", "give a Model"),
    "sf.save(model, None)": ("save: path is None", "give the path of a file"),
    "sf.load(model)": ("load: path is a Model", "give the path of a file"),
    "sf.load(None)": ("load: path is None", "give the path of a file"),
    "sf.inject('drive.csv', [fault])": ("inject: log is a str", "give a Log"),
    "sf.inject(log, fault)": ("inject: faults is a Fault", "give a list of sf.Fault"),
    "sf.inject(log, ['offset:gyro'])": ("inject: faults holds a str ('offset:gyro')", "give a list of sf.Fault"),
    "sf.Live(log)": ("Live: model is a Log", "give a Model"),
    "sf.Live('car.sensorfault')": ("Live: model is a str ('car.sensorfault')", "give a Model"),
    "live.push(0.0, None)": ("live: value is None", "numbers, one for each channel"),
    "live.push(0.0, 'abc')": ("live: value is a str ('abc')", "numbers, one for each channel"),
    "live.push(0.0, {'x': 1.0})": ("live: value is a dict", "numbers, one for each channel"),
    "live.push(None, values)": ("live: time is None", "in seconds"),
    "live.push('now', values)": ("live: time is a str ('now')", "in seconds"),
    "sf.read(None)": ("read: path is None", "give a file, a folder"),
    "sf.read(3)": ("read: path is an int (3)", "give a file, a folder"),
    "sf.read([1, 2])": ("read: path is a list", "give a file, a folder"),
    "sf.read(log)": ("read: path is a Log", "has been read already"),
    "sf.read('drive.csv', vehicle=3)": ("read: vehicle is an int (3)", "give the path of a vehicle.toml"),
    "sf.write('drive.csv', log)": ("write: log is a str", "give a Log"),
    "sf.write_events(found, log, 'events.csv')": ("write_events: events is a Detection", "sf.Event"),
    "sf.write_page(log, 'page.html')": ("write_page: detection is a Log", "give a Detection"),
    "sf.plot(model)": ("plot: detection is a Model", "give a Detection"),
    "sf.plot(found, sensors='gyro')": ("plot: sensors is a str ('gyro')", "give a list of sensor names"),
    "sf.judge(log, [])": ("judge: detection is a Log", "give a Detection"),
    "sf.campaign(log, model)": ("campaign: model is a Log", "give a Model"),
}
TRIED = """
import json, sys
sys.path.insert(0, sys.argv[1])
import fitted
import sensorfault as sf
log = fitted.unseen().between(end_s=110.0)
model = fitted.model("pca")
found = sf.detect(model, log)
fault = sf.Fault("offset", "gyro", "x", 102.0, 2.0, 1.0)
live = sf.Live(model)
values = log.value[0]
said = {}
for call in json.loads(sys.stdin.read()):
    try:
        eval(call)
        said[call] = ["nothing", ""]
    except Exception as error:
        said[call] = [type(error).__name__, str(error)]
print(json.dumps(said))
"""


def test_a_wrong_type_is_one_sentence_that_says_what_to_give() -> None:
    """By itself: while tests run, beartype would speak first."""
    command = [sys.executable, "-c", TRIED, str(Path(__file__).parent)]
    environment = os.environ | {"PYTHONPATH": str(SOURCE.parent)}
    asked = json.dumps(list(WRONG))
    done = subprocess.run(command, input=asked, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    for call, (what, give) in WRONG.items():
        kind, sentence = said[call]
        assert kind == "TypeError", (call, kind, sentence)
        assert sentence.startswith(what), call
        assert give in sentence, call
        assert sentence.endswith(".")
        assert "\n" not in sentence


def test_help_says_what_goes_in_and_what_may_go_wrong() -> None:
    for name in ("read", "fit", "detect", "inject", "plot", "write_page"):
        text = str(getattr(sf, name).__doc__)
        assert "Args:" in text, name
        assert "Raises:" in text, name
        assert "TypeError: " in text, name
    assert "[s]" in str(sf.Live.push.__doc__)
