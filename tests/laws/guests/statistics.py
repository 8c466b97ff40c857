"""Small test statistics on a residual and its covariance."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from sensorfault.core.types import Residual, Score, Trust


def one_a_channel(value: Float[Array, " C"], valid) -> Score:
    each = jnp.eye(value.size, dtype=bool)
    return Score(value, valid, each, each.astype(float))


class Absolute(eqx.Module):
    """|residual|."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        return one_a_channel(jnp.abs(residual.value), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


class Normalized(eqx.Module):
    """|residual| over its standard deviation, each channel by itself."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        return one_a_channel(jnp.abs(residual.value) / jnp.sqrt(jnp.diagonal(residual.cov)), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


class Outlier(eqx.Module):
    """|(S^-1 z)_i| / sqrt((S^-1)_ii) over the valid channels: one lie shows in the tests of all its neighbours."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        valid = residual.valid
        s = jnp.where(valid[:, None] & valid[None, :], residual.cov, 0.0) + jnp.diag((~valid).astype(float))
        inverse = jnp.linalg.inv(s)
        w = jnp.abs(inverse @ jnp.where(valid, residual.value, 0.0)) / jnp.sqrt(jnp.diagonal(inverse))
        return one_a_channel(w, valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


class Window(NamedTuple):
    ring: Float[Array, "C W"]
    total: Float[Array, " C"]
    count: Int[Array, " C"]  # how many were ever taken in


class WindowMean(eqx.Module):
    """|mean| sqrt(W) of the last W normalised residuals of each channel: evidence, so it takes every valid one."""

    channels: int = eqx.field(static=True)
    width: int = eqx.field(static=True)

    def init(self) -> Window:
        ring = jnp.zeros((self.channels, self.width))
        return Window(ring, ring.sum(axis=1), jnp.zeros(self.channels, jnp.int32))

    def evaluate(self, state: Window, residual: Residual) -> tuple[Score, Window]:
        valid, rows, slot = residual.valid, jnp.arange(self.channels), state.count % self.width
        oldest = state.ring[rows, slot]
        newest = jnp.where(valid, residual.value / jnp.sqrt(jnp.diagonal(residual.cov)), oldest)
        total = state.total + newest - oldest
        count = state.count + valid.astype(jnp.int32)
        score = one_a_channel(jnp.abs(total) / jnp.sqrt(float(self.width)), valid & (count >= self.width))
        return score, Window(state.ring.at[rows, slot].set(newest), total, count)

    def update(self, pending: Window, trust: Trust) -> Window:
        return pending
