"""Means of healthy innovations over the windows of a bank, and their spread."""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.types import Residual
from sensorfault.numerics.blocks import enough
from sensorfault.stages.statistic.means import Means

SHARE, NORMAL = 0.99, 2.5758  # share of the healthy means within a limit, and that limit for the normal distribution


def windows(length_s: tuple[float, ...], spacing_s: float, gap_s: float, channels: int) -> Means:
    """Windows of these lengths, not yet fitted (spread 1). Epochs are `spacing_s` apart or closer."""
    return Means(
        jnp.asarray(length_s),
        jnp.ones(len(length_s)),
        jnp.asarray(spacing_s),
        jnp.asarray(gap_s),
        channels,
        enough(max(length_s), spacing_s),
    )


def mean_tape(means: Means, normalised: Float[np.ndarray, "T C"], period_s: float) -> Float[np.ndarray, "T C W"]:
    """The means after every epoch of a healthy run; epochs are `period_s` apart; NaN where nothing was tested.

    `normalised`: z_i / √S_ii, NaN where nothing was tested.
    """
    time = period_s * np.arange(len(normalised))
    return np.asarray(_over(means, jnp.asarray(time), jnp.asarray(normalised)))


@jax.jit
def _over(means: Means, time: Float[Array, " T"], normalised: Float[Array, "T C"]) -> Float[Array, "T C W"]:
    unit, none = jnp.eye(normalised.shape[1]), jnp.zeros(normalised.shape[1], bool)

    def one(past: Any, row: tuple[Array, Array]) -> tuple[Any, Float[Array, "C W"]]:
        now, normal = row
        valid = jnp.isfinite(normal)
        value = jnp.where(valid, normal, 0.0)
        mean, past = means.over(past, Residual(now, value, unit, value, value, value, valid, none))
        return past, jnp.where(valid[:, None], mean, jnp.nan)

    return jax.lax.scan(one, means.init(), (time, normalised))[1]


def fit_spread(means: Means, tape: Float[np.ndarray, "M W"]) -> Means:
    """With spreads such that all windows exceed a common limit equally often, whatever their tails and their memory.

    `tape`: healthy means of all channels and runs, NaN where nothing was tested. A spread is the standard deviation of
    the normal distribution with the same two-sided 99 % limit.
    """
    spread = np.nanquantile(np.abs(tape), SHARE, axis=0) / NORMAL
    return replace(means, spread=means.spread * jnp.asarray(spread))
