"""What healthy innovations make of the windows of a bank: their means, and how wide those spread."""

from dataclasses import replace
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.monitor.statistic.means import Means
from sensorfault.numerics.blocks import enough
from sensorfault.types import Residual

SHARE, NORMAL = 0.99, 2.5758  # of the healthy means within a limit, and where that limit is if they are normal


def windows(length_s: tuple[float, ...], spacing_s: float, gap_s: float, channels: int) -> Means:
    """Windows of these lengths, not yet fitted: their spread is 1. Epochs are `spacing_s` apart or closer."""
    return Means(
        jnp.asarray(length_s),
        jnp.ones(len(length_s)),
        jnp.asarray(spacing_s),
        jnp.asarray(gap_s),
        channels,
        enough(max(length_s), spacing_s),
    )


def mean_tape(means: Means, told: Residual) -> Float[np.ndarray, "T C W"]:
    """The means after every sample of a healthy run's residuals, stacked over time; NaN where nothing was tested."""
    return np.asarray(_over(means, told))


@eqx.filter_jit
def _over(means: Means, told: Residual) -> Float[Array, "T C W"]:
    def one(past: Any, row: Residual) -> tuple[Any, Float[Array, "C W"]]:
        mean, past = means.over(past, row)
        return past, jnp.where(row.valid[:, None], mean, jnp.nan)

    return jax.lax.scan(one, means.init(), told)[1]


def fit_spread(means: Means, tape: Float[np.ndarray, "M W"]) -> Means:
    """With spreads by which all windows pass a limit equally often, however heavy their tails and long their memory.

    `tape`: healthy means of all channels and runs, NaN where nothing was tested. A spread is that of the normal law
    with the same two-sided 99 % limit.
    """
    spread = np.nanquantile(np.abs(tape), SHARE, axis=0) / NORMAL
    return replace(means, spread=means.spread * jnp.asarray(spread))


def means_of(innovations: Float[np.ndarray, "T C"], lengths: tuple[int, ...]) -> Float[np.ndarray, "M W"]:
    """Means of each channel's normalised innovations over the last so many samples, all channels one below the other.

    NaN where one of them is missing.
    """
    sums = np.cumsum(np.pad(np.nan_to_num(innovations), ((1, 0), (0, 0))), axis=0)
    there = np.cumsum(np.pad(np.isfinite(innovations), ((1, 0), (0, 0))), axis=0)
    means = np.full((*innovations.shape, len(lengths)), np.nan)
    for k, n in enumerate(lengths):
        whole = there[n:] - there[:-n] == n
        means[n - 1 :, :, k] = np.where(whole, (sums[n:] - sums[:-n]) / n, np.nan)
    return means.reshape(-1, len(lengths))
