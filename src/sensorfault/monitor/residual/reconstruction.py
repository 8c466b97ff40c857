"""Reconstruction residual: a sample minus what one hidden layer makes of it (autoencoder, principal components)."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.networks import ACTIVATIONS
from sensorfault.types import Residual, Sample, Trust


class _Work(NamedTuple):
    value: Float[Array, " C"]
    trusted: Float[Array, " C"]


class Reconstruction(eqx.Module):
    """x~ = B f(W x + b) on inputs mapped to [-1, 1] by their training extremes.

    Min et al. 2021, equations (3)-(4). Channels with `watched` False carry no weight and are never valid. An absent
    input is stood in for by the last value that was trusted, so that the other channels keep their verdicts.
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

    def init(self) -> Float[Array, " C"]:
        return self.center

    def reconstruct(self, value: Float[Array, " C"]) -> Float[Array, " C"]:
        """What the network makes of one sample [SI]."""
        # x in [-1, 1]
        x = (value - self.center) / self.half
        # (3) h_j = f(sum_i w_ji x_i + b_j)
        h = ACTIVATIONS[self.activation](self.weights @ x + self.bias)
        # (4) x~_k = sum_j beta_jk h_j
        return (self.output @ h + self.offset) * self.half + self.center

    def evaluate(self, trusted: Float[Array, " C"], sample: Sample) -> tuple[Residual, _Work]:
        value = jnp.where(sample.present, sample.value, trusted)
        expected = jnp.where(self.watched, self.reconstruct(value), value)
        residual = Residual(
            time=sample.time,
            value=value - expected,
            cov=self.cov,
            measured=value,
            expected=expected,
            noise=jnp.diagonal(self.cov),
            valid=sample.fresh & self.watched,
            born=sample.born,
        )
        return residual, _Work(value, trusted)

    def update(self, pending: _Work, trust: Trust) -> Float[Array, " C"]:
        return jnp.where(trust.measured, pending.value, pending.trusted)
