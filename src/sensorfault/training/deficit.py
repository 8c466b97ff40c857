"""The deficits of position and velocity on a healthy drive."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from itertools import combinations

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import extra_tape
from sensorfault.logs.table import Log
from sensorfault.stages.residual.motion_deficit import MotionDeficit
from sensorfault.stages.residual.velocity_deficit import VelocityDeficit

TIMES = (1.0, 2.0, 4.0, 8.0)  # ages of the references on which a law is fitted, in horizons
SLOTS = 32  # stored references during the fit
FINEST_M = 0.1  # no receiver is assumed to be better
FINEST_M_S = 0.03


def fit_deficit(part: MotionDeficit, log: Log) -> MotionDeficit:
    """Fit the laws on a healthy drive: variance of the deficit [m^2] = law . (1, swing^2, path^2, age^2).

    The law of each horizon is fitted on references up to eight times as old; none grows more slowly with age than that
    of the longest.
    """
    laws = np.stack([_law(part, log, float(horizon) * np.array(TIMES)) for horizon in np.asarray(part.horizon_s)])
    laws[:, 3] = np.maximum(laws[:, 3], laws[-1, 3])
    fitted: MotionDeficit = eqx.tree_at(lambda p: p.law, part, jnp.asarray(laws))
    return fitted


def fit_velocity(part: VelocityDeficit, log: Log) -> VelocityDeficit:
    """Fit the mean square of the slip on a healthy drive."""
    tape = extra_tape(part, log)
    slip = tape.slip[tape.ready]
    variance = (slip**2).mean(axis=0) if len(slip) else np.ones(2)
    fitted: VelocityDeficit = eqx.tree_at(lambda p: p.variance, part, jnp.asarray(np.maximum(variance, FINEST_M_S**2)))
    return fitted


def _law(part: MotionDeficit, log: Log, ages: Float[np.ndarray, " n"]) -> Float[np.ndarray, "4"]:
    wide = MotionDeficit(
        law=jnp.ones((len(ages), 4)),
        horizon_s=jnp.asarray(ages),
        spacing_s=jnp.asarray(ages[-1] / (SLOTS - 2)),
        afresh_s=jnp.asarray(2 * ages[-1]),
        inertial=part.inertial,
        position=part.position,
        velocity=part.velocity,
        polar=part.polar,
        channels=part.channels,
        slots=SLOTS,
    )
    tape = extra_tape(wide, log)
    ready = tape.ready
    if not ready.any():
        return np.array([FINEST_M**2, 0.0, 0.0, 0.0])
    square = (tape.deficit[ready] ** 2).sum(axis=1)
    terms = np.stack([np.ones_like(square), tape.swing[ready] ** 2, tape.path[ready] ** 2, tape.age[ready] ** 2], 1)
    # the scatter of a square is proportional to its expectation; the floor keeps small ones from dominating
    usual = max(square[tape.age[ready] < 2 * ages[0]].mean(), FINEST_M**2)
    weight = np.ones(len(square))
    law = np.zeros(4)
    for _ in range(10):
        law = not_negative(terms / weight[:, None], square / weight)
        weight = terms @ law + usual
    return np.maximum(law, [FINEST_M**2, 0.0, 0.0, 0.0])


def not_negative(a: Float[np.ndarray, "N n"], b: Float[np.ndarray, " N"]) -> Float[np.ndarray, " n"]:
    """Least squares with non-negative coefficients, for a few of them: the best subset without a negative one."""
    n = a.shape[1]
    gram, right = a.T @ a, a.T @ b
    best, found = 0.0, np.zeros(n)
    for size in range(1, n + 1):
        for chosen in combinations(range(n), size):
            k = list(chosen)
            x = np.linalg.lstsq(gram[np.ix_(k, k)], right[k], rcond=None)[0]
            cost = x @ gram[np.ix_(k, k)] @ x - 2 * x @ right[k]
            if (x >= 0).all() and cost < best:
                best, found = cost, np.zeros(n)
                found[k] = x
    return found
