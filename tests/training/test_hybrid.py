"""Hybrid training: least squares and gradients against textbook ones, the step rule by its words, known functions."""

import jax
import numpy as np
import pytest

from sensorfault.logs.table import LogError
from sensorfault.numerics.fuzzy import Premises
from sensorfault.training.consequents import Lesson, Numbers, solve
from sensorfault.training.fuzzy import Fitted, Setting, fit_anfis
from sensorfault.training.hybrid import StepRule, hybrid, slope
from sensorfault.training.labelled import Labelled, unit_range
from sensorfault.training.partition import grid, scatter, subtractive
from sensorfault.training.population import population

KINDS = ("bell", "gaussian", "triangle")


def lesson(premises: Premises, seed: int = 0, rows: int = 60, ridge: float = 1e-6) -> Lesson:
    rng = np.random.default_rng(seed)
    x = rng.uniform(0, 1, (rows, 3))
    return Lesson.of(premises, x, np.sin(4 * x[:, 0]) * x[:, 1] + x[:, 2], ridge)


def predicted(fitted: Fitted, features: np.ndarray, start: bool = False) -> np.ndarray:
    return jax.tree.map(np.asarray, fitted.start if start else fitted.model)(features)


def ranges(seed: int, rows: int = 200) -> Labelled:
    """Features of a scalar filter's innovations, and true errors: of eight ranges one is far off."""
    rng = np.random.default_rng(seed)
    error = np.where(rng.random(rows) < 0.12, rng.choice([-1, 1], rows) * rng.uniform(9, 60, rows), 0.0)
    error = error + 2.5 * rng.standard_normal(rows)
    r, s = error + rng.standard_normal(rows), 11.0
    return Labelled(np.column_stack([np.abs(r), r**2 / s, 9 * np.maximum(1, r**2 / s)]), np.abs(error))


@pytest.mark.parametrize("kind", KINDS)
def test_consequents_are_least_squares(kind: str) -> None:
    """What they leave is what an independent solver leaves, on a design built in loops; a triangle's are not unique."""
    premises = grid(3, 2, kind)
    given = lesson(premises, ridge=1e-13)
    x = given.one[:, :3]
    design = np.zeros((60, 8, 4))
    for n, row in enumerate(x):
        for r, rule in enumerate(premises.rules):
            for m in rule:
                t = (row[premises.inputs[m]] - premises.center[m]) / premises.width[m]
                mu = {"bell": 1 / (1 + t**4), "gaussian": np.exp(-t * t / 2), "triangle": max(0.0, 1 - abs(t))}[kind]
                design[n, r, 3] = mu if m == rule[0] else design[n, r, 3] * mu
            design[n, r, :3] = design[n, r, 3] * row
        design[n] /= design[n, :, 3].sum()
    design = design.reshape(60, -1)
    want, *_ = np.linalg.lstsq(design, given.y)
    result = solve(Numbers.of(premises), given)
    np.testing.assert_allclose(result.left, design @ want - given.y, rtol=0, atol=1e-6)
    np.testing.assert_allclose(design @ result.consequents.reshape(-1) - given.y, result.left, rtol=0, atol=1e-9)
    if kind != "triangle":
        np.testing.assert_allclose(result.consequents.reshape(-1), want, rtol=1e-5, atol=1e-6)


def test_two_features_that_are_one_share_their_slope() -> None:
    rng = np.random.default_rng(0)
    x = rng.uniform(0, 1, (50, 1))
    one = Premises(np.full(2, 0.5), np.full(2, 9.0), np.ones(2), (0, 1), ((0, 1),), "gaussian")
    result = solve(Numbers.of(one), Lesson.of(one, np.hstack([x, x]), 3 * x[:, 0] + 1)).consequents
    np.testing.assert_allclose(result, [[1.5, 1.5, 1.0]], rtol=1e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_the_slope_is_that_of_differences(kind: str) -> None:
    """Of the mean square error with the consequents held, and, since they are at their best, with them solved anew."""
    premises = grid(3, 2, kind)
    given = lesson(premises, ridge=1e-12)
    rng = np.random.default_rng(2)
    numbers = Numbers(*(x * rng.uniform(0.9, 1.2, x.size) + 0.03 for x in Numbers.of(premises)))
    solved = solve(numbers, given)
    result = slope(numbers, given, solved)
    for k, name in enumerate(Numbers._fields):
        if name == "slope" and kind != "bell":
            assert not result.slope.any()
            continue
        for p in range(6):
            errors = np.zeros((2, 2))
            for s, step in enumerate((1e-6, -1e-6)):
                moved = numbers[k].copy()
                moved[p] += step
                other = numbers._replace(**{name: moved})
                errors[s] = [solve(other, given, held).error ** 2 for held in (solved.consequents, None)]
            want = (errors[0] - errors[1]) / 2e-6
            np.testing.assert_allclose(result[k][p], want[0], rtol=1e-5, atol=1e-8)
            np.testing.assert_allclose(result[k][p], want[1], rtol=1e-2, atol=1e-5)


def test_the_step_rule_is_jangs() -> None:
    rule, errors = StepRule(1.0), [5.0]
    sizes = []
    for change in [-1, -1, -1, -1, -1, -1, -1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, 1]:
        errors.append(errors[-1] + 0.1 * change)
        rule.adapt(errors)
        sizes.append(round(rule.size, 6))
    # four decreases at the 4th and the 8th change; two times up and down at the 12th and the 16th
    assert sizes == [1.0] * 3 + [1.1] * 4 + [1.21] * 4 + [1.089] * 4 + [0.9801] * 3


def test_it_learns_jangs_first_example() -> None:
    """sinc(x) sinc(y) on 121 points, four memberships an input, 250 epochs: Jang 1993, section V, example 1."""
    at = np.stack(np.meshgrid(np.linspace(-10, 10, 11), np.linspace(-10, 10, 11)), axis=-1).reshape(-1, 2)
    result = fit_anfis(
        at + 10, np.sinc(at / np.pi).prod(axis=1), Setting(memberships=4, ridge=1e-9, step=0.02, epochs=250)
    )
    assert result.learned[0] == pytest.approx(0.105, abs=1e-3)
    assert result.rmse < 0.01
    assert result.rmse == min(result.learned)


@pytest.mark.parametrize("log", [True, False])
@pytest.mark.parametrize("partition", ["grid", "scatter", "subtractive"])
def test_it_foretells_the_error_of_a_range(partition: str, log: bool) -> None:
    features, target = ranges(0)
    result = fit_anfis(features, target, Setting(partition=partition, log=log, radius=0.2, epochs=40))
    assert result.rmse <= result.learned[0]
    np.testing.assert_allclose(result.rmse, np.sqrt(np.mean((predicted(result, features) - target) ** 2)), rtol=1e-9)
    np.testing.assert_allclose(
        result.learned[0], np.sqrt(np.mean((predicted(result, features, start=True) - target) ** 2)), rtol=1e-9
    )
    other, error = ranges(1)
    assert np.sqrt(np.mean((predicted(result, other) - error) ** 2)) < 0.4 * error.std()


def test_the_best_epoch_is_that_of_the_rows_unseen() -> None:
    seen, unseen = ranges(0, 40), ranges(1, 100)
    result = fit_anfis(*seen, Setting(epochs=60, step=0.1), unseen)
    assert len(result.validated) == len(result.learned) == 61
    assert result.best_epoch == int(np.argmin(result.validated))
    error = np.sqrt(np.mean((predicted(result, unseen.features) - unseen.target) ** 2))
    np.testing.assert_allclose(error, min(result.validated), rtol=1e-9)


def test_a_population_finds_no_worse() -> None:
    features, target = ranges(3, 60)
    setting = Setting(premises="population", epochs=3)
    result, again = (fit_anfis(features, target, setting) for _ in range(2))
    assert result.rmse < result.start.consequents.size * result.learned[0]
    assert result.rmse <= fit_anfis(features, target, Setting(epochs=0)).rmse
    assert all(b <= a for a, b in zip(result.learned, result.learned[1:], strict=False))
    np.testing.assert_array_equal(result.model.premises.center, again.model.premises.center)
    unseen = ranges(4, 60)
    judged = fit_anfis(features, target, setting, unseen)
    error = np.sqrt(np.mean((predicted(judged, unseen.features) - unseen.target) ** 2))
    np.testing.assert_allclose(error, judged.validated[-1], rtol=1e-9)


def test_a_population_begins_where_the_rules_are() -> None:
    """What the rules say perfectly as they begin is not lost to individuals by chance."""
    premises = grid(3, 2)
    begin = lesson(premises, ridge=1e-13)
    exact = begin._replace(y=begin.y + solve(Numbers.of(premises), begin).left)
    assert population(Numbers.of(premises), exact, None, 1, 0).learned[-1] < 1e-6


def test_a_grid_has_every_combination_and_crosses_at_a_half() -> None:
    for kind in KINDS:
        premises = grid(2, 3, kind)
        assert premises.rules == tuple((a, b) for a in (0, 1, 2) for b in (3, 4, 5))
        grades = np.exp(premises.grades(np.array([[0.25, 0.75]])))[0]
        np.testing.assert_allclose(grades[[0, 1, 4, 5]], 0.5)
        assert premises.grades(np.array([[0.5, 1.0]]))[0][[1, 5]] == pytest.approx([0, 0], abs=1e-9)


def test_scattered_rules_stand_on_rows() -> None:
    x = np.random.default_rng(0).uniform(0, 1, (30, 3))
    for seed in (0, 1):
        centers = scatter(x, 25, seed).center.reshape(25, 3)
        assert len({tuple(c) for c in centers}) == 25
        assert {tuple(c) for c in centers} <= {tuple(row) for row in x}
    assert len(scatter(x[:4], 6).rules) == 4


def chius(joint: np.ndarray, radius: float) -> list[int]:
    """Chiu 1994, row by row: rb = 1.5 ra, accepted above 0.5 of the first potential, rejected below 0.15."""

    def near(k: int, reach: float) -> np.ndarray:
        return np.array([np.exp(-4 * ((row - joint[k]) ** 2).sum() / reach**2) for row in joint])

    p = sum(near(k, radius) for k in range(len(joint)))
    first, found = max(p), []
    while (best := max(p)) > 0.15 * first:
        k = int(np.argmax(p))
        apart = min((np.sqrt(((joint[k] - joint[f]) ** 2).sum()) for f in found), default=np.inf)
        if best <= 0.5 * first and apart / radius + best / first < 1:
            p[k] = 0
            continue
        found.append(k)
        p = p - best * near(k, 1.5 * radius)
    return found


@pytest.mark.parametrize("seed", range(5))
def test_subtractive_clusters_are_chius(seed: int) -> None:
    rng = np.random.default_rng(seed)
    x = np.vstack([rng.uniform(0, 1, (25, 2)), rng.normal(0.2, 0.05, (20, 2)), rng.normal(0.8, 0.1, (15, 2))])
    y = 5 * x[:, 0] + rng.uniform(-1, 1, 60)
    joint = np.column_stack([x, (y - y.min()) / np.ptp(y)])
    for radius in (0.15, 0.35):
        want = chius(joint, radius)
        np.testing.assert_array_equal(subtractive(x, y, radius).center.reshape(-1, 2), x[want])
    assert subtractive(x, np.zeros(60), 3.0).rules == ((0, 1),)


def test_a_feature_that_never_moves_does_no_harm() -> None:
    features, target = ranges(0)
    features[:, 2] = 9.0
    for setting in (Setting(epochs=20), Setting(epochs=20, log=True), Setting(partition="subtractive", epochs=5)):
        result = fit_anfis(features, target, setting)
        assert np.isfinite(predicted(result, features * 3)).all()
        assert result.rmse < target.std()


def test_an_innovation_of_nought_does_not_stretch_the_range_of_logarithms() -> None:
    features = np.array([[0.0], [4.0], [4.0], [4.0], [40.0]])
    unit = unit_range(features, log=True)
    np.testing.assert_allclose(unit.low, np.log(0.04))
    np.testing.assert_allclose(unit(features)[:, 0], np.log([1, 100, 100, 100, 1000]) / np.log(1000))


def test_five_rows_or_one_that_is_not_finite_are_refused() -> None:
    features, target = ranges(0, 50)
    bad = features.copy()
    bad[7, 1] = np.nan
    unknown = np.where(np.arange(50) == 9, np.inf, target)
    for case, words in (
        ((features[:5], target[:5]), "5 measurements"),
        ((bad, target), "row 7"),
        ((features, unknown), "row 9"),
        ((-features, target), "is negative"),
    ):
        with pytest.raises(LogError, match=words) as raised:
            fit_anfis(*case)
        assert str(raised.value).count(".") == 1


def test_hybrid_without_epochs_is_the_partition() -> None:
    premises = grid(3, 2)
    result = hybrid(Numbers.of(premises), lesson(premises), None, 0, 0.1)
    np.testing.assert_array_equal(result.numbers.center, premises.center)
    assert result.best_epoch == 0
