"""Fuzzy rules in words: a sentence for each rule, and the memberships as a table."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Anfis

WORDS = {1: ("any",), 2: ("small", "large"), 3: ("small", "middling", "large")}


class Membership(NamedTuple):
    """One membership function in units of its feature.

    If the model uses logarithms, `width` is in units of the logarithm; `center` is always in the feature's unit.
    """

    feature: str
    word: str
    center: float
    width: float
    slope: float


def memberships(model: Anfis, names: Sequence[str]) -> tuple[Membership, ...]:
    """All memberships of a model, in the order of its premises. `names`: of the features."""
    arrays = jax.tree.map(np.asarray, model)
    premises, words = arrays.premises, _words(arrays)
    of = list(premises.inputs)
    span, low = arrays.unit.span[of], arrays.unit.low[of]
    center = low + span * premises.center
    center = np.exp(center) if arrays.unit.log else center
    return tuple(
        Membership(names[i], words[p], float(center[p]), float(premises.width[p] * span[p]), float(premises.slope[p]))
        for p, i in enumerate(of)
    )


def sentences(model: Anfis, names: Sequence[str], output: str = "error", unit: str = "m") -> tuple[str, ...]:
    """Each rule as a sentence: 'If the innovation is small and .., the error is 1.2 m + 0.3 innovation + ...'.

    Features are in their own units, or as logarithms if the model uses these.
    """
    arrays = jax.tree.map(np.asarray, model)
    words = _words(arrays)
    written = [f"ln {name}" if arrays.unit.log else name for name in names]
    slopes = arrays.consequents[:, :-1] / arrays.unit.span
    constants = arrays.consequents[:, -1] - slopes @ arrays.unit.low
    return tuple(
        f"If {_premise(arrays, rule, words, names)}, the {output} is {_line(constant, slope, written, unit)}."
        for rule, slope, constant in zip(arrays.premises.rules, slopes, constants, strict=True)
    )


def _premise(model: Anfis, rule: tuple[int, ...], words: Sequence[str], names: Sequence[str]) -> str:
    parts = [f"the {names[model.premises.inputs[p]]} is {words[p]}" for p in rule]
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if parts[:-1] else parts)


def _line(constant: float, slopes: Float[np.ndarray, " F"], names: Sequence[str], unit: str) -> str:
    terms = [f"{'-' if slope < 0 else '+'} {abs(slope):.3g} {name}" for slope, name in zip(slopes, names, strict=True)]
    return " ".join([f"{constant:.3g} {unit}", *terms])


def _words(model: Anfis) -> list[str]:
    """A word for each membership by its rank among those of its input; with many memberships, its center."""
    return [_word(model, p) for p in range(len(model.premises.inputs))]


def _word(model: Anfis, p: int) -> str:
    premises, unit = model.premises, model.unit
    i = premises.inputs[p]
    beside = [q for q, other in enumerate(premises.inputs) if other == i]
    if len(beside) in WORDS:
        order = sorted(beside, key=lambda q: premises.center[q])
        return WORDS[len(beside)][order.index(p)]
    center = unit.low[i] + unit.span[i] * premises.center[p]
    return f"about {np.exp(center) if unit.log else center:.3g}"
