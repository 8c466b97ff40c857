"""Models of the default method as files, and what method a model file is of; read without a compiler."""

import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from sensorfault.core.expect import expect_path
from sensorfault.core.files import appearing
from sensorfault.logs.table import Channel, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.relations.axes import Mounting
from sensorfault.relations.events import METHOD
from sensorfault.relations.limits import Learned
from sensorfault.runtime.compared import Comparison
from sensorfault.runtime.described import known

KEY, FORMAT = "sensorfault", 1
LONGEST = 1 << 26  # bytes of a header; more is no model of ours


class ModelError(LogError):
    """A model that cannot be written, or a file that cannot be used: what is wrong with it, and what to do."""


def header_of(path: Path) -> dict[str, Any]:
    """The header of a model file: all that it says but its arrays.

    Raises:
        ModelError: there is no such file, or it is no model.
    """
    if not path.is_file():
        raise ModelError(f"{path}: there is no such model file; make one with 'sensorfault fit LOG --out {path.name}'.")
    refused = ModelError(f"{path}: not a model file, or truncated; fit the model again.")
    with path.open("rb") as file:
        length = int.from_bytes(file.read(8), "little")
        if not 2 <= length <= min(LONGEST, path.stat().st_size):
            raise refused
        text = file.read(length)
    try:
        meta = json.loads(text).get("__metadata__", {})
        header = json.loads(meta[KEY]) if KEY in meta else None
    except (ValueError, AttributeError, TypeError, RecursionError):
        raise refused from None
    if header is None:
        raise ModelError(f"{path}: a safetensors file, but not of sensorfault; give a file that 'fit' wrote.")
    if not isinstance(header, dict):
        raise refused
    return {**header, "digest": meta.get("digest"), "text": meta[KEY]}


def known_in(path: Path) -> VehicleFile | None:
    """What a model file knows of the columns of its logs, all of them; read without its arrays.

    Raises:
        ModelError: there is no such file, or it is no model.
        LogError: what it says of the columns cannot be read.
    """
    header = header_of(path)
    summary = header.get("summary")
    if not isinstance(summary, dict) or not isinstance(header.get("channels"), list):
        return None
    whole = header.get("framing") is not None or header.get("method") == METHOD
    try:
        inputs = None if whole else [Channel(**channel).path for channel in header["channels"]]
        found = known(summary, inputs, [Sensor(**sensor) for sensor in header.get("sensors", ())])
    except TypeError:  # loading it says more
        return None
    return replace(found, where=f"the model {path}") if found is not None else None


def method_of(path: Path) -> str:
    """The method that a model file is of.

    Raises:
        ModelError: as `header_of`.
    """
    return str(header_of(path).get("method", ""))


def write_comparison(comparison: Comparison, path: Path | str) -> None:
    """Write a fitted comparison, whole or not at all.

    Raises:
        ModelError: it was not fitted.
        TypeError: something else than a path.
    """
    expect_path(path, "save: path")
    learned = comparison.learned
    if learned is None:
        raise ModelError("this comparison was not fitted; fit one with sf.fit(log).")
    header = {
        "format": FORMAT,
        "method": METHOD,
        "rates": learned.rates,
        "limit": learned.limit,
        "lags": learned.lags,
        "facts": learned.facts,
        "mountings": {number: _mounting_out(one) for number, one in learned.mountings.items()},
        "vehicle": learned.vehicle,
        "summary": comparison.summary,
        "channels": [vars(channel) for channel in comparison.channels],
        "sensors": [vars(sensor) for sensor in comparison.sensors],
    }
    text = json.dumps(header, sort_keys=True)
    meta = {"__metadata__": {KEY: text, "digest": hashlib.sha256(text.encode()).hexdigest()}}
    whole = json.dumps(meta).encode()
    with appearing(Path(path)) as temporary:
        temporary.write_bytes(len(whole).to_bytes(8, "little") + whole)


def read_comparison(path: Path | str) -> Comparison:
    """Read a comparison that `write_comparison` wrote.

    Raises:
        ModelError: it is damaged, changed, or of another format.
    """
    header = header_of(Path(path))
    if header["digest"] != hashlib.sha256(header["text"].encode()).hexdigest():
        raise ModelError(f"{path}: its contents were changed after it was written; fit the model again.")
    if header.get("format") != FORMAT:
        raise ModelError(
            f"{path}: written in format {header.get('format')}, this version reads {FORMAT}; fit it again."
        )
    try:
        numbers = {
            name: {str(k): float(v) for k, v in header[name].items()} for name in ("rates", "limit", "lags", "facts")
        }
        mountings = {str(k): _mounting_in(v) for k, v in header["mountings"].items()}
        learned = Learned(**numbers, mountings=mountings, vehicle=str(header["vehicle"]))
        channels = tuple(Channel(**channel) for channel in header["channels"])
        sensors = tuple(Sensor(**sensor) for sensor in header["sensors"])
        return Comparison(learned, dict(header["summary"]), channels, sensors)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ModelError(f"{path}: its header does not describe a model ({error}); fit the model again.") from None


def _mounting_out(one: Mounting) -> dict[str, Any]:
    turn = None if one.turn is None else one.turn.tolist()
    return {"turn": turn, "gravity": one.gravity, "forward": one.forward, "yaw": one.yaw, "why": one.why}


def _mounting_in(one: dict[str, Any]) -> Mounting:
    turn = None if one["turn"] is None else np.asarray(one["turn"], float).reshape(3, 3)
    return Mounting(turn, float(one["gravity"]), bool(one["forward"]), bool(one["yaw"]), str(one["why"]))
