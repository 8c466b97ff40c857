"""A model file: the same to the bit after loading, and nothing else is ever taken for one."""

import hashlib
import json
import re
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from safetensors import safe_open
from safetensors.numpy import save_file

import fitted
import sensorfault.runtime.store
from sensorfault.logs.table import LogError
from sensorfault.runtime import former
from sensorfault.runtime.detect import detect
from sensorfault.runtime.encoding import decode, encode
from sensorfault.runtime.model import Model
from sensorfault.runtime.store import ModelError, load, save
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.averaged_baarda_w import AveragedBaardaW
from sensorfault.stages.statistic.baarda_w import BaardaW
from sensorfault.stages.statistic.one_sided import OneSided
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.statistic.stuck_position import StuckPosition
from sensorfault.stages.threshold.fixed import Fixed


@cache
def stored(method: str = "pca") -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "car.sensorfault"
        save(fitted.model(method), path)
        return path.read_bytes()


def sentence(raised: "pytest.ExceptionInfo[ModelError]", path: Path) -> str:
    """The message, which is one line that names the file and ends as a sentence."""
    text = str(raised.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    assert text.endswith(".")
    return text


def refused(path: Path) -> str:
    with pytest.raises(ModelError) as raised:
        load(path)
    return sentence(raised, path)


def put(folder: Path, content: bytes) -> Path:
    path = folder / "car.sensorfault"
    path.write_bytes(content)
    return path


def opened(content: bytes, folder: Path) -> tuple[dict, dict[str, np.ndarray]]:
    with safe_open(put(folder, content), framework="numpy") as file:
        return json.loads(file.metadata()["sensorfault"]), {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118


def sealed(header: object, tensors: dict[str, np.ndarray], path: Path) -> Path:
    """A file with this header and a digest that fits it, as a forger would write it."""
    text = header if isinstance(header, str) else json.dumps(header)
    digest = hashlib.sha256(text.encode())
    for name, tensor in sorted(tensors.items()):
        digest.update(f"{name} {tensor.dtype.str} {tensor.shape}".encode() + tensor.tobytes())
    save_file(tensors, path, {"sensorfault": text, "digest": digest.hexdigest()})
    return path


def same(one: Model, two: Model) -> None:
    leaves, structure = jax.tree.flatten(one.monitor)
    back, again = jax.tree.flatten(two.monitor)
    assert structure == again
    for before, after in zip(leaves, back, strict=True):
        assert np.asarray(before).dtype == np.asarray(after).dtype
        assert np.asarray(before).shape == np.asarray(after).shape
        assert np.asarray(before).tobytes() == np.asarray(after).tobytes()
    nothing = fitted.model("pca").monitor
    assert replace(one, monitor=nothing) == replace(two, monitor=nothing)


@pytest.mark.parametrize("method", ["elm-autoencoder", "pca"])
def test_the_same_to_the_bit(method: str, tmp_path: Path) -> None:
    model = fitted.model(method)
    save(model, tmp_path / "car.sensorfault")
    same(model, load(tmp_path / "car.sensorfault"))
    same(model, load(str(tmp_path / "car.sensorfault")))


def test_the_same_verdicts_to_the_bit(tmp_path: Path) -> None:
    log = fitted.lying().log
    again = detect(load(put(tmp_path, stored("elm-autoencoder"))), log)
    want = fitted.found()
    assert again.events == want.events
    for name in ("channel", "sensor", "sample", "repaired"):
        assert getattr(again, name).tobytes() == getattr(want, name).tobytes()
    for one, two in zip(again.traces, want.traces, strict=True):
        assert (one.name, one.channel) == (two.name, two.channel)
        assert one.score.tobytes() == two.score.tobytes()
        assert one.limit.tobytes() == two.limit.tobytes()


def test_saved_twice_says_the_same(tmp_path: Path) -> None:
    path = tmp_path / "again.sensorfault"
    save(load(put(tmp_path, stored())), path)
    (header, tensors), (again, numbers) = (opened(content, tmp_path) for content in (stored(), path.read_bytes()))
    assert header == again
    assert {name: tensor.tobytes() for name, tensor in tensors.items()} == {
        name: tensor.tobytes() for name, tensor in numbers.items()
    }


@given(
    st.lists(st.floats(allow_nan=True, allow_infinity=True, width=64), min_size=8, max_size=8),
    st.floats(0.0, 1.0),
)
@settings(max_examples=20, deadline=None)
def test_any_number_in_any_part_survives(limits: list[float], share: float) -> None:
    monitor = fitted.model("pca").monitor
    odd = eqx.tree_at(
        lambda m: (m.branches[1].threshold, m.decision, m.recovery),
        monitor,
        (Fixed(jnp.asarray(limits)), Exceed(share), Drop()),
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "odd.sensorfault"
        save(replace(fitted.model("pca"), monitor=odd), path)
        same(replace(fitted.model("pca"), monitor=odd), load(path))


def test_the_header_can_be_read_by_people(tmp_path: Path) -> None:
    header, _ = opened(stored(), tmp_path)
    model = fitted.model("pca")
    assert header["method"] == "pca"
    assert [(c["sensor"], c["name"], c["unit"]) for c in header["channels"]] == [
        (c.sensor, c.name, c.unit) for c in model.channels
    ]
    assert header["summary"]["training_log"] == "rig 0"
    assert set(header["versions"]) >= {"sensorfault", "jax", "numpy"}
    assert header["format"] == 1


def test_every_length_but_the_whole_is_refused(tmp_path: Path) -> None:
    whole = stored()
    short = {*range(0, 64), *range(0, len(whole), 173), *range(len(whole) - 20, len(whole))}
    for length in sorted(short):
        refused(put(tmp_path, whole[:length]))
    for more in (b"\0", b"more", whole):
        refused(put(tmp_path, whole + more))


@given(st.data())
@settings(max_examples=150, deadline=None)
def test_a_flipped_byte_is_refused(data: st.DataObject) -> None:
    whole = bytearray(stored())
    at = data.draw(st.integers(0, len(whole) - 1))
    was = whole[at]
    whole[at] ^= data.draw(st.integers(1, 255))
    if was == 0x20 and whole[at] in b"\t\n\r":
        return  # one white space for another between two words of JSON: the same header, not another
    with TemporaryDirectory() as folder:
        refused(put(Path(folder), bytes(whole)))


def test_a_flipped_bit_anywhere_is_refused(tmp_path: Path) -> None:
    whole = stored()
    for at in range(0, len(whole), 61):
        changed = bytearray(whole)
        changed[at] ^= 1 << at % 8
        refused(put(tmp_path, bytes(changed)))


@given(st.binary(max_size=300))
@settings(max_examples=50, deadline=None)
def test_any_other_file_is_refused(content: bytes) -> None:
    with TemporaryDirectory() as folder:
        refused(put(Path(folder), content))


def test_files_that_are_no_models(tmp_path: Path) -> None:
    foreign = tmp_path / "foreign.safetensors"
    save_file({"weight": np.zeros(3)}, foreign, {"format": "pt"})
    assert "but not of sensorfault" in refused(foreign)
    bare = tmp_path / "bare.safetensors"
    save_file({"weight": np.zeros(3)}, bare)
    refused(bare)
    text = tmp_path / "drive.csv"
    text.write_text("time,gyro_z\n0,1\n0.02,2\n")
    refused(text)
    (tmp_path / "empty").touch()
    refused(tmp_path / "empty")
    assert "no such model file" in refused(tmp_path)
    missing = refused(tmp_path / "there" / "car.sensorfault")
    assert "no such model file" in missing
    assert "sensorfault fit" in missing
    assert issubclass(ModelError, LogError)


def test_another_format_is_named(tmp_path: Path) -> None:
    header, tensors = opened(stored(), tmp_path)
    assert load(sealed(header, tensors, tmp_path / "fine")).method == "pca"
    for number in (0, 2, "1", None):
        assert f"format {number}" in refused(sealed(header | {"format": number}, tensors, tmp_path / "other"))


FORGERIES = {
    "unknown part": lambda h: h["monitor"].update(part="os.system"),
    "unknown inner part": lambda h: h["monitor"]["fields"]["decision"].update(part="Popen"),
    "a part that is no monitor": lambda h: h.update(monitor=h["monitor"]["fields"]["decision"]),
    "no monitor": lambda h: h.pop("monitor"),
    "a missing field": lambda h: h["monitor"]["fields"].pop("owner"),
    "a foreign field": lambda h: h["monitor"]["fields"].update(command="rm"),
    "a tensor that is not there": lambda h: h["monitor"]["fields"].update(hold_s={"tensor": "nowhere"}),
    "no channels": lambda h: h.pop("channels"),
    "a foreign key of a channel": lambda h: h["channels"][0].update(colour="red"),
    "a foreign key of a sensor": lambda h: h["sensors"][0].update(colour="red"),
}


@pytest.mark.parametrize("forgery", FORGERIES)
def test_a_header_that_describes_no_model_is_refused(forgery: str, tmp_path: Path) -> None:
    header, tensors = opened(stored(), tmp_path)
    FORGERIES[forgery](header)
    refused(sealed(header, tensors, tmp_path / "forged"))


def test_nothing_is_pickled() -> None:
    """Neither by the package nor by what saving and loading bring along unasked."""
    forbidden = re.compile(
        r"\b(pickle|cPickle|dill|joblib|shelve|marshal|cloudpickle|allow_pickle|eval|exec)\b\s*[\(.,\n]"
    )
    files = sorted(Path(sensorfault.__file__).parent.rglob("*.py"))
    assert len(files) > 50
    for file in files:
        code = "\n".join(line for line in file.read_text().splitlines() if "never pickle" not in line.lower())
        assert not forbidden.search(code), file


def test_the_old_file_stays_when_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = put(tmp_path, stored())

    def full(tensors: object, file: Path, meta: object) -> None:
        file.write_bytes(b"half a mod")
        raise OSError(28, "No space left on device", str(file))

    monkeypatch.setattr(sensorfault.runtime.store, "save_file", full)
    with pytest.raises(OSError, match="No space"):
        save(fitted.model(), path)
    assert path.read_bytes() == stored()
    with pytest.raises(OSError, match="No space"):
        save(fitted.model(), tmp_path / "new.sensorfault")
    assert [file.name for file in tmp_path.iterdir()] == ["car.sensorfault"]


class Local(eqx.Module):
    """A decision that stands in no room."""

    def init(self) -> tuple[()]:
        return ()


class Exact(eqx.Module):
    """The name of a part that is saved, and another class."""


Exact.__name__ = Exact.__qualname__ = "Exceed"

REFUSED = {
    "a value": (object(), "a object cannot be saved; make it an array, a number or a name."),
    "a number that JSON lacks": (float("nan"), "a float cannot be saved; make it an array, a number or a name."),
    "a class from elsewhere": (Local(), "'load' would not know the class Local, so it cannot be saved; "),
    "a namesake": (Exact(), "'load' would not know the class Exceed, so it cannot be saved; "),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_stored_is_said_and_leaves_no_file(what: str, tmp_path: Path) -> None:
    part, sentence = REFUSED[what]
    monitor = eqx.tree_at(lambda m: m.decision, fitted.model("pca").monitor, part)
    with pytest.raises(ModelError) as raised:
        save(replace(fitted.model("pca"), monitor=monitor), tmp_path / "odd.sensorfault")
    text = str(raised.value)
    assert text.startswith(f"monitor.decision: {sentence}")
    assert "\n" not in text
    assert text.endswith(".")
    assert not list(tmp_path.iterdir())


BAARDA = BaardaW()
FORMER = {
    "Of": SelectResidual(BAARDA, 1),
    "Late": OneSided(),
    "Freed": BAARDA,
    "AveragedFreed": AveragedBaardaW(jnp.asarray(20.0), 8, 5),
    "Standing": StuckPosition(jnp.ones(8, bool), (6, 7)),
}


def renamed(header: object, old: str, new: str) -> object:
    """The header with every part `new` called `old`."""
    match header:
        case dict():
            named = {key: renamed(value, old, new) for key, value in header.items()}
            return named | {"part": old} if header.get("part") == new else named
        case list():
            return [renamed(one, old, new) for one in header]
        case _:
            return header


@pytest.mark.parametrize("name", former.PARTS)
def test_a_file_that_names_a_part_as_it_was_loads(name: str, tmp_path: Path) -> None:
    """As the only part, and in the monitor of a model if its tests are as many as the channels."""
    part, now = FORMER[name], former.PARTS[name]
    tensors: dict[str, np.ndarray] = {}
    old = renamed(encode(part, "part", tensors), name, now)
    assert old["part"] == name
    assert eqx.tree_equal(decode(old, tensors), part)
    if now not in ("BaardaW", "OneSided"):
        return
    model = fitted.model("pca")
    model = replace(model, monitor=eqx.tree_at(lambda m: m.branches[1].statistic, model.monitor, part))
    path = tmp_path / "now.sensorfault"
    save(model, path)
    header, tensors = opened(path.read_bytes(), tmp_path)
    before = renamed(header, name, now)
    assert before != header
    same(model, load(sealed(before, tensors, tmp_path / "before.sensorfault")))


@pytest.mark.parametrize(("old", "now"), former.METHODS.items())
def test_a_file_that_names_its_method_as_it_was_loads(old: str, now: str, tmp_path: Path) -> None:
    header, tensors = opened(stored(), tmp_path)
    assert load(sealed(header | {"method": old}, tensors, tmp_path / "before.sensorfault")).method == now


def test_killed_while_writing_leaves_the_old_file(tmp_path: Path) -> None:
    """The process dies in the middle of the write: what stands under the name is the old file, whole."""
    path = put(tmp_path, stored())
    code = (
        "import os, pathlib\n"
        "from sensorfault.core.files import appearing\n"
        f"with appearing(pathlib.Path({str(path)!r})) as file:\n"
        "    file.write_bytes(b'half')\n"
        "    os._exit(9)\n"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 9
    assert path.read_bytes() == stored()
