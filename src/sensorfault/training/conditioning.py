"""Linear conditioning: predict the newest row from the rows before it, by their joint covariance."""

from itertools import pairwise

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.stages.residual.conditioning import Conditioning
from sensorfault.training.unbroken import LAGS, unbroken

BOUND = 3.0  # conditional sigmas; of 2, 3 and 4 the best compromise on two real drives
RIDGE = 1e-8  # share of a channel's variance, for channels that depend on each other


def fit_conditioning(
    time: Float[np.ndarray, " T"],
    value: Float[np.ndarray, "T C"],
    complete: Bool[np.ndarray, " T"],
    watched: Bool[np.ndarray, " C"],
    lags: int = LAGS,
    bound: float = BOUND,
    levels: bool = True,
) -> Conditioning:
    """Fit on healthy rows [SI] of one clock; `complete`: rows that have every watched channel.

    Without `levels` the change of a row is regressed on the changes before it: a lasting offset of one channel then
    does not shift what is expected of the others.
    """
    channels = len(watched)
    tick_s = float(np.median(np.diff(time)))
    rows = value[complete]
    center = np.where(watched, rows.mean(axis=0), 0.0)
    sigma = np.where(watched, rows.std(axis=0), 1.0)
    x = np.where(watched & complete[:, None], (value - center) / sigma, 0.0)
    at = np.flatnonzero(unbroken(time, complete, lags))
    # joint covariance of [x_t, x_t-1 .. x_t-W], or of the differences between them
    stacked = [x[at - lag] for lag in range(lags + 1)]
    joint = np.concatenate(stacked if levels else [a - b for a, b in pairwise(stacked)], axis=1)
    s = joint.T @ joint / len(at) + RIDGE * np.eye(joint.shape[1])
    now, past = slice(channels), slice(channels, None)
    # A = S_xy S_yy^-1,  S_x|y = S_xx - S_xy S_yy^-1 S_yx
    a = np.linalg.solve(s[past, past], s[past, now]).T
    cov = s[now, now] - a @ s[past, now]
    if not levels:
        # x_t-1 + sum_j B_j (x_t-j - x_t-j-1), as weights of the rows: A_j = B_j - B_j-1, B_0 = -I, B_W = 0
        one = np.eye(channels)
        a = np.concatenate([a, 0 * one], axis=1) - np.concatenate([-one, a], axis=1)
    second = max(round(1 / tick_s), 1)
    changed = x[second:] - x[:-second] if len(x) > second else x
    drift = (changed**2).mean(axis=0) / (second * tick_s)
    return Conditioning(
        weights=jnp.asarray(a * sigma[:, None] / np.tile(sigma, lags)),
        center=jnp.asarray(center),
        cov=jnp.asarray(np.where(np.eye(channels, dtype=bool) & ~watched, 1.0, cov * np.outer(sigma, sigma))),
        drift=jnp.asarray(drift * sigma**2),
        most=jnp.asarray(np.where(watched, 2 * sigma**2, 0.0)),
        tick_s=jnp.asarray(tick_s),
        bound=jnp.asarray(bound),
        watched=jnp.asarray(watched),
        lags=lags,
    )
