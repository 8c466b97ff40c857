"""Rules in words say what the model computes."""

import re

import jax
import numpy as np
import pytest

from sensorfault.numerics.innovation import FEATURES
from sensorfault.training.fuzzy import Setting, fit_anfis
from sensorfault.training.rules import memberships, sentences


def fitted(**setting):
    rng = np.random.default_rng(0)
    r = np.abs(rng.normal(0, 8, 80))
    return fit_anfis(np.column_stack([r, r**2 / 10, 9 + r]), r + rng.random(80), Setting(epochs=5, **setting)).model


@pytest.mark.parametrize("log", [True, False])
def test_a_sentence_has_the_rules_own_numbers(log: bool) -> None:
    model = fitted(memberships=1, log=log)
    (result,) = sentences(model, ("alpha", "beta", "gamma"), "range error")
    written = "ln " if log else ""
    assert re.fullmatch(
        r"If the alpha is any, the beta is any and the gamma is any, the range error is -?[\d.e+-]+ m "
        rf"[+-] [\d.e-]+ {written}alpha [+-] [\d.e-]+ {written}beta [+-] [\d.e-]+ {written}gamma\.",
        result,
    )
    terms = re.findall(rf"([+-]) ([\d.e-]+) {written}", result)
    constant = float(re.search(r"error is (\S+) m", result)[1])
    for row in (np.array([3.0, 2.0, 20.0]), np.array([8.0, 6.0, 14.0])):
        seen = np.log(row) if log else row
        want = float(jax.tree.map(np.asarray, model)(row))
        says = constant + sum(float(sign + size) * x for (sign, size), x in zip(terms, seen, strict=True))
        assert says == pytest.approx(want, abs=0.02 * (abs(constant) + 10))


def test_words_go_by_the_order_of_the_centers() -> None:
    model = fitted()
    result = sentences(model, FEATURES)
    assert len(result) == 8
    assert result[0].startswith(
        "If the innovation is small, the squared Mahalanobis distance is small and the adapted noise is small, "
    )
    table = memberships(model, FEATURES)
    assert [one.feature for one in table] == [name for name in FEATURES for _ in range(2)]
    for small, large in zip(table[::2], table[1::2], strict=True):
        assert (small.word, large.word) == ("small", "large")
        assert small.center < large.center
    low, span = np.asarray(model.unit.low), np.asarray(model.unit.span)
    assert table[3].center == pytest.approx(low[1] + span[1] * float(model.premises.center[3]))
    assert table[3].width == pytest.approx(span[1] * float(model.premises.width[3]))
    assert [one.word for one in memberships(fitted(memberships=3), FEATURES)][:3] == ["small", "middling", "large"]


def test_many_rules_of_their_own_are_named_by_where_they_lie() -> None:
    model = fitted(partition="scatter", rules=5, log=True)
    result, table = sentences(model, FEATURES), memberships(model, FEATURES)
    assert len(result) == 5
    assert f"the innovation is about {table[0].center:.3g}, " in result[0]
