"""Save a fitted model to one file and load it, bit for bit: safetensors with a JSON header. No code is executed."""

import hashlib
import json
from pathlib import Path
from typing import Any

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save_file

from sensorfault.core.expect import MODEL, expect, expect_path
from sensorfault.core.files import appearing
from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Sample
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Channel, Sensor
from sensorfault.relations.events import METHOD
from sensorfault.runtime import former
from sensorfault.runtime.compared import Comparison
from sensorfault.runtime.encoding import Tensors, decode, encode
from sensorfault.runtime.model import Model, owners
from sensorfault.runtime.saved import ModelError, method_of, read_comparison, write_comparison

FORMAT = 1


def save(model: Model | Comparison, path: Path | str) -> None:
    """Write a model to a file, whole or not at all.

    The header is JSON under the key `sensorfault`: format, versions, method, channels with units, sensors, summary, the
    monitor's parts, and a digest over header and numbers.

    Raises:
        ModelError: a part of the monitor that `load` would not know, or that holds what cannot be written.
        TypeError: something else than a model or a path.
    """
    expect(model, (Model, Comparison), "save: model", MODEL)
    if isinstance(model, Comparison):
        write_comparison(model, path)
        return
    assert isinstance(model, Model)
    expect_path(path, "save: path")
    tensors: Tensors = {}
    header = {
        "format": FORMAT,
        "versions": _versions(),
        "method": model.method,
        "channels": [vars(channel) for channel in model.channels],
        "sensors": [vars(sensor) for sensor in model.sensors],
        "tests": model.tests,
        "watched": model.watched,
        "tick_s": model.tick_s,
        "sigma": model.sigma,
        "summary": model.summary,
        "framing": vars(model.framing) if model.framing else None,
        "monitor": encode(model.monitor, "monitor", tensors),
    }
    text = json.dumps(header, sort_keys=True)
    with appearing(Path(path)) as temporary:
        try:
            save_file(tensors, temporary, {"sensorfault": text, "digest": _digest(text, tensors)})
        except SafetensorError as error:
            raise ModelError(f"{path}: cannot be written ({error}); make room, or write somewhere else.") from None


def load(path: Path | str) -> Model | Comparison:
    """Read a model that `save` wrote.

    Raises:
        ModelError: there is no such file, it is another kind of file, truncated, changed since it was written, or of
            another format.
        TypeError: something else than a path.
    """
    expect_path(path, "load: path")
    path = Path(path)
    if method_of(path) == METHOD:
        return read_comparison(path)
    refit = "fit the model again"
    try:
        with safe_open(path, framework="numpy") as file:
            meta = file.metadata() or {}
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
    except (SafetensorError, OSError, ValueError) as error:
        raise ModelError(f"{path}: not a model file, or truncated ({error}); {refit}.") from None
    if "sensorfault" not in meta:
        raise ModelError(f"{path}: a safetensors file, but not of sensorfault; give a file that 'fit' wrote.")
    text = meta["sensorfault"]
    if meta.get("digest") != _digest(text, tensors):
        raise ModelError(f"{path}: its contents were changed after it was written; {refit}.")
    try:
        header = json.loads(text)
        if header["format"] != FORMAT:
            raise ModelError(f"{path}: written in format {header['format']}, this version reads {FORMAT}; {refit}.")
        monitor = decode(header["monitor"], tensors)
        if not isinstance(monitor, Monitor):
            raise TypeError("it holds no monitor")
        model = Model(
            former.METHODS.get(header["method"], header["method"]),
            monitor,
            tuple(Channel(**channel) for channel in header["channels"]),
            tuple(Sensor(**sensor) for sensor in header["sensors"]),
            tuple((name, channel) for name, channel in header["tests"]),
            tuple(header["watched"]),
            header["tick_s"],
            tuple(header["sigma"]),
            header["summary"],
            _framing(header.get("framing")),
        )
        _try(model)
        return model
    except ModelError:
        raise
    except (KeyError, IndexError, AttributeError, TypeError, ValueError, RecursionError, OverflowError) as error:
        raise ModelError(f"{path}: its header does not describe a model ({error}); {refit}.") from None


def _try(model: Model) -> None:
    """Trace one step without computing it: parts that do not fit together are refused before the model is used."""
    channels = len(model.channels)
    if owners(model.channels, model.sensors) != model.monitor.owner or not model.tick_s > 0:
        raise ValueError("its channels, sensors and clock do not match")
    if not channels == len(model.watched) == len(model.sigma):
        raise ValueError("the number of its channels and of 'watched' or 'sigma' differ")
    none = jnp.zeros(channels, bool)
    block = jax.tree.map(jnp.asarray, model.framing.nothing) if model.framing else ()
    sample = Sample(jnp.zeros(()), jnp.zeros(channels), none, none, none, block)
    after, result = jax.eval_shape(lambda: model.monitor.step(model.monitor.init(), sample))
    before = jax.eval_shape(model.monitor.init)
    if jax.tree.map(jnp.shape, after) != jax.tree.map(jnp.shape, before):
        raise ValueError("a step changes the shape of its state")
    if sum(score.value.shape[0] for score in result.scores) != len(model.tests):
        raise ValueError("the number of its tests and of their names differ")


def _framing(header: dict[str, Any] | None) -> Framing | None:
    if header is None:
        return None
    fields: dict[str, Any] = {name: tuple(one) if isinstance(one, list) else one for name, one in header.items()}
    return Framing(**fields)


def _versions() -> dict[str, str]:
    from importlib.metadata import version

    return {name: version(name) for name in ("sensorfault", "jax", "equinox", "numpy")}


def _digest(text: str, tensors: Tensors) -> str:
    digest = hashlib.sha256(text.encode())
    for name in sorted(tensors):
        tensor = tensors[name]
        digest.update(f"{name} {tensor.dtype.str} {tensor.shape}".encode() + np.ascontiguousarray(tensor).tobytes())
    return digest.hexdigest()
