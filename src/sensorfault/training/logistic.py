"""Logistic regression: the odds that a measurement is wrong, learned from measurements with known errors."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import LogError
from sensorfault.numerics.logistic import Logistic
from sensorfault.training.labelled import checked, unit_range

C = 100.0  # inverse strength of the penalty: with 1, a few anomalies do not move weights of features within [0, 1]


def fit_logistic(
    features: Float[np.ndarray, "N F"],
    off: Bool[np.ndarray, " N"],
    log: bool = True,
    reach: float = 1.0,
    c: float = C,
) -> Logistic:
    """Maximum likelihood with an L2 penalty of 1 / c on the weights. `features` as for ANFIS; `off`: error above T1.

    Raises:
        LogError: too few rows, rows that are not finite, or all rows of one class.
    """
    from scipy.optimize import minimize  # lazily: slow to import, and seldom needed
    from scipy.special import expit

    checked(features, off.astype(float))
    if off.all() or not off.any():
        raise LogError(
            f"{'all' if off.any() else 'none'} of the {len(off)} training measurements are wrong; give both kinds."
        )
    unit = unit_range(features, log, reach)
    x = np.column_stack([unit(features), np.ones(len(off))])
    penalty = np.append(np.full(x.shape[1] - 1, 1 / c), 0.0)
    sign = np.where(off, 1.0, -1.0)

    def cost(w: Float[np.ndarray, " n"]) -> tuple[float, Float[np.ndarray, " n"]]:
        # Σ ln(1 + e^(∓ w x)) + |w|² / 2c
        margin = sign * (x @ w)
        value = np.logaddexp(0, -margin).sum() + (penalty * w**2).sum() / 2
        return float(value), penalty * w - x.T @ (sign * expit(-margin))

    def bend(w: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n n"]:
        p = expit(x @ w)
        return np.asarray((x * (p * (1 - p))[:, None]).T @ x + np.diag(penalty))

    w = minimize(cost, np.zeros(x.shape[1]), jac=True, hess=bend, method="trust-exact", options={"gtol": 1e-9}).x
    model: Logistic = jax.tree.map(jnp.asarray, Logistic(unit, w[:-1], w[-1]))
    return model
