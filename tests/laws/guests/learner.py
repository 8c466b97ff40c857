"""A predictor that learns while it watches, and a limit that does."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Sample, Trust


class Learned(NamedTuple):
    weights: Float[Array, "C 3"]
    past: Float[Array, "C 2"]  # the last two values taken in, the newest first
    known: Bool[Array, "C 2"]


class Step(NamedTuple):
    state: Learned
    inputs: Float[Array, "C 3"]
    error: Float[Array, " C"]


class Nlms(eqx.Module):
    """y(k+1) = w . (y(k), y(k-1), 1) for each channel, learned by normalised least mean squares.

    The stand-in of a rebuilt channel enters the window, never the weights. A window with a hole is not tested, so that
    after the stand-ins have run out the channel is taken at its word again.
    """

    rate: Float[Array, ""]
    channels: int = eqx.field(static=True)

    def init(self) -> Learned:
        weights = jnp.zeros((self.channels, 3)).at[:, 0].set(1.0)
        return Learned(weights, jnp.zeros((self.channels, 2)), jnp.zeros((self.channels, 2), bool))

    def evaluate(self, state: Learned, sample: Sample) -> tuple[Residual, Step]:
        inputs = jnp.concatenate([state.past, jnp.ones((self.channels, 1))], axis=1)
        expected = (state.weights * inputs).sum(axis=1)
        error = sample.value - expected
        residual = Residual(
            time=sample.time,
            value=error,
            cov=jnp.eye(self.channels),
            measured=sample.value,
            expected=expected,
            noise=jnp.ones(self.channels),
            valid=sample.fresh & state.known.all(axis=1),
            born=sample.born,
        )
        return residual, Step(state, inputs, error)

    def update(self, step: Step, trust: Trust) -> Learned:
        weights, past, known = step.state
        energy = 0.1 + (step.inputs**2).sum(axis=1)
        change = self.rate * (step.error / energy)[:, None] * step.inputs
        weights = weights + jnp.where(trust.learn[:, None], change, 0.0)
        taken = trust.measured | trust.filled
        newest = jnp.where(taken, trust.value, past[:, 0])
        return Learned(weights, jnp.stack([newest, past[:, 0]], axis=1), jnp.stack([taken, known[:, 0]], axis=1))


class Spread(NamedTuple):
    variance: Float[Array, " C"]
    count: Float[Array, " C"]


class RunningSigma(eqx.Module):
    """`times` the running standard deviation of the residual; silent until `least` residuals were learned."""

    times: Float[Array, ""]
    least: Float[Array, ""]
    channels: int = eqx.field(static=True)

    def init(self) -> Spread:
        return Spread(jnp.zeros(self.channels), jnp.zeros(self.channels))

    def evaluate(self, state: Spread, seen) -> tuple[Float[Array, " C"], tuple[Spread, Array]]:
        residual, _ = seen
        limit = jnp.where(state.count < self.least, jnp.inf, self.times * jnp.sqrt(state.variance))
        return limit, (state, residual.value)

    def update(self, pending, trust: Trust) -> Spread:
        (variance, count), error = pending
        share = jnp.maximum(1 / (count + 1), 0.02)
        return Spread(
            jnp.where(trust.learn, variance + share * (error**2 - variance), variance),
            count + trust.learn.astype(float),
        )
