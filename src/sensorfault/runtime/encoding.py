"""The parts of a monitor as JSON and arrays, and back. Only registered parts are written, and only those are built."""

import math
from dataclasses import fields
from typing import Any

import sensorfault.core._jax  # isort: skip  # noqa: F401

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from sensorfault.runtime import former, registry
from sensorfault.runtime.saved import ModelError

Tensors = dict[str, np.ndarray]


def encode(thing: Any, name: str, tensors: Tensors) -> Any:
    """A part as JSON; its arrays are added to `tensors` under their path in the tree, which begins with `name`.

    Raises:
        ModelError: a class that `decode` would not know, or a value that is no array, number, name or part.
    """
    match thing:
        case eqx.Module() if registry.parts().get(type(thing).__name__) is not type(thing):
            raise ModelError(
                f"{name}: 'load' would not know the class {type(thing).__qualname__}, so it cannot be saved; put it "
                f"into a module of {', '.join(registry.ROOMS)}."
            )
        case eqx.Module():
            inner = {f.name: encode(getattr(thing, f.name), f"{name}.{f.name}", tensors) for f in fields(thing)}
            return {"part": type(thing).__name__, "fields": inner}
        case jax.Array() | np.ndarray():
            tensors[name] = np.asarray(thing)
            return {"tensor": name}
        case tuple():
            return [encode(one, f"{name}.{i}", tensors) for i, one in enumerate(thing)]
        case bool() | int() | str() | None:
            return thing
        case float() if math.isfinite(thing):
            return thing
        case _:
            raise ModelError(f"{name}: a {type(thing).__name__} cannot be saved; make it an array, a number or a name.")


def decode(header: Any, tensors: Tensors) -> Any:
    """What `encode` was given.

    Raises:
        KeyError: a part or an array that is not there.
        TypeError: a field that the part does not have, or one that is missing.
    """
    match header:
        case {"tensor": name}:
            return jnp.asarray(tensors[name])
        case {"part": part, "fields": inner}:
            made = registry.parts()[former.PARTS.get(part, part)]
            return made(**{field: decode(one, tensors) for field, one in inner.items()})
        case list():
            return tuple(decode(one, tensors) for one in header)
        case _:
            return header
