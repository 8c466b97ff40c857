"""Learning a range's error from its innovation: rules, trained in several ways, and logistic regression."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import jax
import numpy as np
from jaxtyping import Float

from sensorfault.evaluation.ranking import auc
from sensorfault.training.fuzzy import Setting, fit_anfis
from sensorfault.training.labelled import Labelled
from sensorfault.training.learning_curve import SIZES, Answer, learning_curve
from sensorfault.training.logistic import fit_logistic
from sensorfault_studies.numbers import Numbers

ANFIS, LOGISTIC = "anfis-cubature-9m", "logistic-cubature"
PRINTED = "grid"
GENERATIONS = 30
SETTINGS: Mapping[str, Setting] = {
    PRINTED: Setting(),
    "untrained": Setting(epochs=0),
    "gaussian": Setting(kind="gaussian"),
    "triangle": Setting(kind="triangle"),
    "log": Setting(log=True, ridge=1e-4),
    "scatter": Setting(partition="scatter"),
    "subtractive": Setting(partition="subtractive", radius=0.3),
    "population": Setting(premises="population", epochs=GENERATIONS),
}
CURVES = (PRINTED, "log")

Fit = Callable[[Labelled], Answer]


def learners(wrong_m: float, of: Sequence[str] = tuple(SETTINGS)) -> dict[tuple[str, str], Fit]:
    """By method and variant; the answer is by how much a range exceeds its limit: predicted metres, or log odds."""
    rules = {(ANFIS, name): partial(_rules, SETTINGS[name], wrong_m) for name in of}
    return {**rules, (LOGISTIC, ""): partial(_odds, wrong_m)}


def _rules(setting: Setting, wrong_m: float, seen: Labelled) -> Answer:
    model = jax.tree.map(np.asarray, fit_anfis(seen.features, seen.target, setting).model)
    return lambda features: np.asarray(model(features)) - wrong_m


def _odds(wrong_m: float, seen: Labelled) -> Answer:
    model = jax.tree.map(np.asarray, fit_logistic(seen.features, seen.target > wrong_m))
    return lambda features: np.asarray(model(features))


def judged(wrong_m: float, over: Float[np.ndarray, " M"], size: Float[np.ndarray, " M"]) -> dict[str, float]:
    """Xu et al. 2023, (36), (38), (39), and the area under the ROC; NaN if all ranges are of one class.

    `over`: beyond the limit if above 0; `size` of the true errors [m].
    """
    wrong, result = size > wrong_m, over > 0
    some, others = max(int(wrong.sum()), 1), max(int((~wrong).sum()), 1)
    return {
        "accuracy": float((result == wrong).mean()),
        "recall": float((result & wrong).sum() / some) if wrong.any() else float("nan"),
        "fpr": float((result & ~wrong).sum() / others) if (~wrong).any() else float("nan"),
        "auc": auc(over, wrong),
    }


def compared(numbers: Numbers, condition: str, learn: Labelled, test: Labelled, wrong_m: float) -> None:
    """Every way to initialise and train the rules, on the same training and test rows."""
    for (method, variant), fit in learners(wrong_m).items():
        answer = fit(learn)
        over = answer(test.features)
        result = judged(wrong_m, over, test.target)
        if method == ANFIS:
            result["rms"] = float(np.sqrt(np.mean((over + wrong_m - test.target) ** 2)))
        numbers.add(f"{condition} {variant}".strip(), method, result)


def curves(
    numbers: Numbers,
    condition: str,
    learn: Labelled,
    test: Labelled,
    wrong_m: float,
    sizes: Sequence[int] = SIZES,
    draws: int = 5,
) -> None:
    """Learning curves; the number of rows is the last word of the condition."""
    for (method, variant), fit in learners(wrong_m, CURVES).items():
        for size, result in learning_curve(fit, partial(judged, wrong_m), learn, test, sizes, draws):
            words = [condition, variant, f"n{size}"]
            numbers.add(" ".join(word for word in words if word), method, result)
