"""Fuzzy inference against loops in plain Python, and where it could break: at a center, far off, no rule firing."""

import math
from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from laws.strict import strict
from sensorfault.numerics.fuzzy import Anfis, Premises
from sensorfault.numerics.innovation import features
from sensorfault.numerics.logistic import Logistic
from sensorfault.numerics.unit_range import UnitRange

__all__ = ["strict"]

LOW, SPAN = np.array([0.5, 0.0, 9.0]), np.array([20.0, 4.0, 100.0])
KINDS = ("bell", "gaussian", "triangle")


def model(kind: str = "bell", grid: bool = True, log: bool = False, reach: float = 1.0) -> Anfis:
    """Random premises: a grid of two memberships an input, or five rules with memberships of their own."""
    rng = np.random.default_rng(4)
    if grid:
        inputs = (0, 0, 1, 1, 2, 2)
        rules = tuple((a, b, c) for a in (0, 1) for b in (2, 3) for c in (4, 5))
    else:
        inputs, rules = (0, 1, 2) * 5, tuple((3 * r, 3 * r + 1, 3 * r + 2) for r in range(5))
    center, width, slope = (rng.uniform(*span, len(inputs)) for span in ((-0.2, 1.2), (0.4, 1.5), (0.6, 4)))
    unit = UnitRange(LOW, SPAN, np.asarray(reach), log)
    return Anfis(unit, Premises(center, width, slope, inputs, rules, kind), rng.normal(0, 5, (len(rules), 4)))


def membership(kind: str, x: float, a: float, b: float, c: float) -> float:
    if kind == "bell":
        return 1 / (1 + abs((x - c) / a) ** (2 * b))
    return math.exp(-(((x - c) / a) ** 2) / 2) if kind == "gaussian" else max(0.0, 1 - abs((x - c) / a))


def by_hand(anfis: Anfis, seen: np.ndarray) -> float:
    """Equations (21) to (25), one rule after the other."""
    reach = float(anfis.unit.reach)
    size = np.log(seen) if anfis.unit.log else seen
    x = [min(max((f - low) / span, 0.0), 1 + reach) for f, low, span in zip(size, LOW, SPAN, strict=True)]
    p = anfis.premises
    top = bottom = 0.0
    for r, rule in enumerate(p.rules):
        w = 1.0
        for m in rule:
            w *= membership(p.kind, x[p.inputs[m]], float(p.width[m]), float(p.slope[m]), float(p.center[m]))
        says = float(anfis.consequents[r, 3])
        for i in range(3):
            says += float(anfis.consequents[r, i]) * x[i]
        top, bottom = top + w * says, bottom + w
    return top / bottom


all_of = jax.jit(lambda anfis, seen: jax.vmap(anfis)(seen))
slopes = jax.jit(jax.vmap(jax.value_and_grad(lambda anfis, row: anfis(row)), (None, 0)))


def rows(count: int = 40) -> np.ndarray:
    return np.random.default_rng(1).uniform(LOW + 0.01, LOW + 1.3 * SPAN, (count, 3))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("grid", "log"), [(True, False), (False, True)])
def test_it_is_the_papers_five_layers(kind: str, grid: bool, log: bool) -> None:
    anfis = model(kind, grid, log)
    want = [by_hand(anfis, row) for row in rows()]
    np.testing.assert_allclose(all_of(anfis, jnp.asarray(rows())), want, rtol=1e-9)
    in_numpy = anfis(rows())
    assert isinstance(in_numpy, np.ndarray)
    np.testing.assert_allclose(in_numpy, want, rtol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_its_gradient_is_that_of_differences(kind: str) -> None:
    anfis, seen = model(kind), rows(3)
    slope = jax.tree.map(lambda x: np.asarray(x).sum(axis=0), slopes(anfis, jnp.asarray(seen))[1])
    for name in ("center", "width", "slope"):
        for p in range(6):
            result = []
            for step in (1e-6, -1e-6):
                moved = np.array(getattr(anfis.premises, name))
                moved[p] += step
                other = replace(anfis, premises=replace(anfis.premises, **{name: moved}))
                result.append(sum(by_hand(other, row) for row in seen))
            want = 0.0 if name == "slope" and kind != "bell" else (result[0] - result[1]) / 2e-6
            assert abs(float(getattr(slope.premises, name)[p]) - want) < 1e-5, (name, p)


@pytest.mark.parametrize(("kind", "log"), [("bell", False), ("bell", True), ("gaussian", False), ("triangle", True)])
def test_nothing_makes_it_other_than_a_number(kind: str, log: bool) -> None:
    """At a center, at nought, at the largest number there is, and with rules that hardly fire anywhere."""
    anfis = model(kind, log=log, reach=1e6)
    narrow = replace(anfis, premises=replace(anfis.premises, width=anfis.premises.width * 1e-3))
    center = LOW + SPAN * np.asarray(anfis.premises.center)[[0, 2, 4]]
    extremes = jnp.asarray(np.array([center, np.zeros(3), np.full(3, 1e308), np.full(3, np.inf), [1e308, 0, 9]]))
    for one in (anfis, narrow):
        result, slope = slopes(one, extremes)
        assert np.isfinite(result).all()
        assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(slope.premises))


def test_where_no_triangle_reaches_the_nearest_rule_speaks() -> None:
    premises = Premises(jnp.asarray([0.0, 1.0]), jnp.asarray([0.1, 0.1]), jnp.ones(2), (0, 0), ((0,), (1,)), "triangle")
    unit = UnitRange(jnp.zeros(1), jnp.ones(1), jnp.asarray(99.0))
    anfis = Anfis(unit, premises, jnp.asarray([[0.0, 3.0], [0.0, 7.0]]))
    far, left, right = all_of(anfis, jnp.asarray([[60.0], [0.45], [0.55]]))
    assert float(far) == pytest.approx(7.0, abs=1e-3)
    assert 3.0 < float(left) < 5.0 < float(right) < 7.0


def test_a_range_ends_where_nothing_was_learned() -> None:
    unit = UnitRange(jnp.asarray([2.0]), jnp.asarray([4.0]), jnp.asarray(0.5))
    result = [float(unit(jnp.asarray([f]))[0]) for f in (-1.0, 2.0, 4.0, 6.0, 8.0, 1e9)]
    assert result == [0.0, 0.0, 0.5, 1.0, 1.5, 1.5]


def test_features_are_the_papers() -> None:
    value, variance, noise = np.array([-3.0, 0.0, 2.0]), np.array([4.0, 9.0, 1.0]), np.array([20.25, 9.0, 36.0])
    want = [[3.0, 9 / 4, 20.25], [0.0, 0.0, 9.0], [2.0, 4.0, 36.0]]
    np.testing.assert_array_equal(features(value, variance, noise), want)
    np.testing.assert_array_equal(features(*map(jnp.asarray, (value, variance, noise))), want)


def test_log_odds_are_a_weighted_sum() -> None:
    unit = UnitRange(jnp.asarray([0.0, 1.0]), jnp.asarray([2.0, 1.0]), jnp.asarray(5.0), log=True)
    result = Logistic(unit, jnp.asarray([10.0, 100.0]), jnp.asarray(-7.0))(jnp.exp(jnp.asarray([1.0, 3.0])))
    assert float(result) == pytest.approx(10 * 0.5 + 100 * 2.0 - 7)
