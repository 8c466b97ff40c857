"""Leave-one-out bank: member m never listens to channel m, and is believed to be healthy if it agrees with itself."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import NEVER, Residual, Sample, Score, Trust


class Members(NamedTuple):
    """Innovation of every channel as each member sees it, and its variance."""

    value: Float[Array, "M C"]
    variance: Float[Array, "M C"]


class Levels(NamedTuple):
    mean: Float[Array, " M"]
    variance: Float[Array, " M"]
    time: Float[Array, ""]


class Bank(eqx.Module):
    """C sensors of one wandering level; C filters of which each leaves one sensor out."""

    r: Float[Array, " C"]
    q: Float[Array, ""]  # variance that the level gathers in a second

    def init(self) -> Levels:
        return Levels(jnp.zeros_like(self.r), jnp.full_like(self.r, 100.0), jnp.asarray(NEVER, float))

    def evaluate(self, state: Levels, sample: Sample) -> tuple[Residual, tuple[Levels, Array]]:
        dt = jnp.where(state.time == NEVER, 0.0, sample.time - state.time)
        variance = state.variance + self.q * dt
        value = sample.value[None, :] - state.mean[:, None]
        spread = variance[:, None] + self.r[None, :]
        residual = Residual(
            time=sample.time,
            value=jnp.diagonal(value),
            cov=jnp.diag(jnp.diagonal(spread)),
            measured=sample.value,
            expected=state.mean,
            noise=self.r,
            valid=sample.fresh,
            born=sample.born,
            extra=Members(value, spread),
        )
        return residual, (Levels(state.mean, variance, sample.time), value)

    def update(self, pending: tuple[Levels, Array], trust: Trust) -> Levels:
        (mean, variance, time), value = pending
        listens = trust.measured[None, :] & ~jnp.eye(self.r.size, dtype=bool)
        weight = jnp.where(listens, 1 / self.r[None, :], 0.0)
        after = 1 / (1 / variance + weight.sum(axis=1))
        return Levels(mean + after * (weight * jnp.where(listens, value, 0.0)).sum(axis=1), after, time)


class MemberFit(eqx.Module):
    """How badly member m explains the channels it listens to: one test a member, which says nothing of channel m."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        value, variance = residual.extra
        received = residual.valid[None, :] & ~jnp.eye(value.shape[0], dtype=bool)
        square = jnp.where(received, value**2 / variance, 0.0)
        total = square.sum(axis=1)
        blame = square / jnp.where(total > 0, total, 1.0)[:, None]
        return Score(total, received.any(axis=1), received, blame), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
