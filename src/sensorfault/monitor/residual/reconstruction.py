"""Reconstruction residual: a sample minus what one hidden layer makes of it (autoencoder, principal components)."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.networks import ACTIVATIONS
from sensorfault.types import NEVER, Residual, Sample, Trust

PATIENCE_S = 60.0  # how long a doubted channel's last trusted value may stand in as an input of the others


class _Inputs(NamedTuple):
    trusted: Float[Array, " C"]  # last value taken at its own word [SI]
    when: Float[Array, " C"]  # and when that was [s]
    doubted: Bool[Array, " C"]  # the last new measurement was not


class _Work(NamedTuple):
    inputs: _Inputs
    value: Float[Array, " C"]
    fresh: Bool[Array, " C"]
    time: Float[Array, ""]


class Reconstruction(eqx.Module):
    """x~ = B f(W x + b) on inputs mapped to [-1, 1] by their training extremes.

    Min et al. 2021, equations (3)-(4). Channels with `watched` False carry no weight and are never valid. An absent
    input is stood in for by its last trusted value, so that the other channels keep their verdicts; so is one that was
    not trusted in the last sample, so that its fault is not smeared over the others, for at most PATIENCE_S: then all
    are taken as measured, lest two channels go on blaming each other. `expected` is the reconstruction from the last
    trusted value of the channel itself: a copy of a faulty value is no stand-in for it.
    """

    weights: Float[Array, "L C"]  # w
    bias: Float[Array, " L"]  # b
    output: Float[Array, "C L"]  # beta, transposed
    offset: Float[Array, " C"]  # reconstruction of a sample whose hidden layer is silent
    center: Float[Array, " C"]  # middle of the training range [SI]
    half: Float[Array, " C"]  # half of the training range [SI]
    cov: Float[Array, "C C"]  # of the residual on healthy data [SI]
    watched: Bool[Array, " C"]
    activation: str = eqx.field(static=True, default="sigmoid")

    def init(self) -> _Inputs:
        shape = self.center.shape
        return _Inputs(self.center, jnp.full(shape, NEVER), jnp.zeros(shape, bool))

    def evaluate(self, state: _Inputs, sample: Sample) -> tuple[Residual, _Work]:
        trusted = state.trusted
        value = jnp.where(sample.present, sample.value, trusted)
        replaced = state.doubted & (sample.time - state.when <= PATIENCE_S)
        shared = jnp.where(replaced, trusted, value)
        f = ACTIVATIONS[self.activation]
        # x in [-1, 1]
        x = (shared - self.center) / self.half
        # (3) h_j = f(sum_i w_ji x_i + b_j)
        a = self.weights @ x + self.bias
        # (4) x~_k = sum_j beta_jk h_j
        together = self.output @ f(a) + self.offset
        # x~_k once more with x_k alone exchanged: trusted for measured, or measured for doubted
        exchanged = jnp.where(replaced, value, trusted)
        a_k = a + (self.weights * ((exchanged - shared) / self.half)).T
        alone = (self.output * f(a_k)).sum(axis=1) + self.offset
        copy, stand_in = jnp.where(replaced, alone, together), jnp.where(replaced, together, alone)
        residual = Residual(
            time=sample.time,
            value=jnp.where(self.watched, value - self.center - copy * self.half, 0.0),
            cov=self.cov,
            measured=value,
            expected=jnp.where(self.watched, stand_in * self.half + self.center, trusted),
            noise=jnp.diagonal(self.cov),
            valid=sample.fresh & self.watched,
            born=sample.born,
        )
        return residual, _Work(state, value, sample.fresh, sample.time)

    def update(self, pending: _Work, trust: Trust) -> _Inputs:
        inputs, value, fresh, time = pending
        return _Inputs(
            trusted=jnp.where(trust.measured, value, inputs.trusted),
            when=jnp.where(trust.measured, time, inputs.when),
            doubted=jnp.where(fresh, ~trust.measured, inputs.doubted),
        )
