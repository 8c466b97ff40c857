"""ANFIS: fuzzy rules that predict the error of a measurement, learned from measurements with known errors."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from dataclasses import dataclass, replace
from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Anfis, Premises
from sensorfault.training.consequents import RIDGE, Lesson, Numbers, solve
from sensorfault.training.hybrid import hybrid
from sensorfault.training.labelled import Labelled, checked, unit_range
from sensorfault.training.partition import grid, scatter, subtractive
from sensorfault.training.population import population


@dataclass(frozen=True)
class Setting:
    """How the rules are initialised and trained. The defaults are the paper's, as far as it gives them.

    `memberships` on each input of a grid; `rules` of a scatter; `radius` of a subtractive cluster; `kind`: of the
    memberships. `log`, `reach`: see UnitRange; `ridge`: see Lesson. `epochs` with steps of initial length `step`, or as
    many generations.
    """

    partition: Literal["grid", "scatter", "subtractive"] = "grid"
    memberships: int = 2
    rules: int = 8
    radius: float = 0.5
    kind: Literal["bell", "gaussian", "triangle"] = "bell"
    log: bool = False
    reach: float = 1.0
    ridge: float = RIDGE
    premises: Literal["hybrid", "population"] = "hybrid"
    epochs: int = 100
    step: float = 0.01
    seed: int = 0

    def begin(self, x: Float[np.ndarray, "N F"], y: Float[np.ndarray, " N"]) -> Premises:
        """The premises before training, for these scaled features."""
        match self.partition:
            case "grid":
                return grid(x.shape[1], self.memberships, self.kind)
            case "scatter":
                return scatter(x, self.rules, self.seed, self.kind)
            case "subtractive":
                return subtractive(x, y, self.radius, self.kind)


@dataclass(frozen=True)
class Fitted:
    """The model of the best epoch, and the model with untrained premises (with its own consequents).

    `learned`, `validated`: RMS errors by epoch; the first is before any step. `rmse`: of the best epoch, on
    the training rows; the paper's σ, and its limit T2 is 3 σ.
    """

    model: Anfis
    start: Anfis
    rmse: float
    learned: tuple[float, ...]
    validated: tuple[float, ...]
    best_epoch: int


def fit_anfis(
    features: Float[np.ndarray, "N F"],
    target: Float[np.ndarray, " N"],
    setting: Setting = Setting(),
    unseen: Labelled | None = None,
) -> Fitted:
    """Learn the size of the error from the features. Xu et al. 2023, section 2; Jang 1993.

    `features`: sizes in their own units, as numerics/innovation.py has them. `target`: |error| [m], equation (26).
    `unseen`: validation rows, which select the best epoch.

    Raises:
        LogError: too few rows, or rows that are not finite.
    """
    checked(features, target)
    unit = unit_range(features, setting.log, setting.reach)
    x = unit(features)
    begin = setting.begin(x, target)
    lesson = Lesson.of(begin, x, target, setting.ridge)
    other = None if unseen is None else Lesson.of(begin, unit(unseen.features), unseen.target)
    first = Numbers.of(begin)
    if setting.premises == "hybrid":
        course = hybrid(first, lesson, other, setting.epochs, setting.step)
    else:
        course = population(first, lesson, other, setting.epochs, setting.seed)

    def assembled(numbers: Numbers, consequents: Float[np.ndarray, "R D"]) -> Anfis:
        premises = replace(begin, center=numbers.center, width=numbers.width, slope=numbers.slope)
        model: Anfis = jax.tree.map(jnp.asarray, Anfis(unit, premises, consequents))
        return model

    return Fitted(
        model=assembled(course.numbers, course.consequents),
        start=assembled(first, solve(first, lesson).consequents),
        rmse=solve(course.numbers, lesson).error,
        learned=course.learned,
        validated=course.validated,
        best_epoch=course.best_epoch,
    )
