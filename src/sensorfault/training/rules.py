"""What fuzzy rules say, in words: sentences for people, and their memberships as a table."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Anfis

WORDS = {1: ("any",), 2: ("small", "large"), 3: ("small", "middling", "large")}


class Membership(NamedTuple):
    """One membership function in units of its feature, or with logarithms in e-folds beside its center.

    `center` is in the feature's unit either way, `width` is that of the logarithm if there is one.
    """

    feature: str
    word: str
    center: float
    width: float
    slope: float


def memberships(model: Anfis, names: Sequence[str]) -> tuple[Membership, ...]:
    """All of a model's, in the order of its premises. `names`: of the features."""
    result = jax.tree.map(np.asarray, model)
    premises, words = result.premises, _words(result)
    of = list(premises.inputs)
    span, low = result.unit.span[of], result.unit.low[of]
    center = low + span * premises.center
    center = np.exp(center) if result.unit.log else center
    return tuple(
        Membership(names[i], words[p], float(center[p]), float(premises.width[p] * span[p]), float(premises.slope[p]))
        for p, i in enumerate(of)
    )


def sentences(model: Anfis, names: Sequence[str], said: str = "error", unit: str = "m") -> tuple[str, ...]:
    """Each rule as a sentence: 'If the innovation is small and .., the error is 1.2 m + 0.3 innovation + ...'.

    What a rule says is in the features' own units, or of their logarithms where the model takes them.
    """
    result = jax.tree.map(np.asarray, model)
    words = _words(result)
    written = [f"ln {name}" if result.unit.log else name for name in names]
    slopes = result.consequents[:, :-1] / result.unit.span
    constants = result.consequents[:, -1] - slopes @ result.unit.low
    return tuple(
        f"If {_premise(result, rule, words, names)}, the {said} is {_line(constant, slope, written, unit)}."
        for rule, slope, constant in zip(result.premises.rules, slopes, constants, strict=True)
    )


def _premise(model: Anfis, rule: tuple[int, ...], words: Sequence[str], names: Sequence[str]) -> str:
    parts = [f"the {names[model.premises.inputs[p]]} is {words[p]}" for p in rule]
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if parts[:-1] else parts)


def _line(constant: float, slopes: Float[np.ndarray, " F"], names: Sequence[str], unit: str) -> str:
    terms = [f"{'-' if slope < 0 else '+'} {abs(slope):.3g} {name}" for slope, name in zip(slopes, names, strict=True)]
    return " ".join([f"{constant:.3g} {unit}", *terms])


def _words(model: Anfis) -> list[str]:
    """A word for each membership by its place among those of its input; where they are many, where it lies."""
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
