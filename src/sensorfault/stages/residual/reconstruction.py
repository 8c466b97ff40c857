"""Reconstruction residual: a sample minus what one hidden layer makes of it (autoencoder, principal components)."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Sample, Trust
from sensorfault.numerics.networks.activations import ACTIVATIONS


class _Work(NamedTuple):
    value: Float[Array, " C"]
    trusted: Float[Array, " C"]


class Reconstruction(eqx.Module):
    """x~ = B f(W x + b) on inputs mapped to [-1, 1] by their training extremes.

    Min et al. 2021, equations (3)-(4). Channels with `watched` False carry no weight and are never valid. An absent
    input is stood in for by its last trusted value, so that the other channels keep their verdicts.

    `expected[k]` is the reconstruction of channel k from a sample in which x_k alone is exchanged for its last trusted
    value, since a copy of a faulty value is no stand-in for it. `extra[k]` is the whole residual of that sample: what
    would be left if k were the faulty one (after the reconstruction-based contributions of Alcala & Qin 2009).
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

    def evaluate(self, trusted: Float[Array, " C"], sample: Sample) -> tuple[Residual, _Work]:
        value = jnp.where(sample.present, sample.value, trusted)
        f = ACTIVATIONS[self.activation]
        # x in [-1, 1]
        x = (value - self.center) / self.half
        # (3) h_j = f(sum_i w_ji x_i + b_j)
        a = self.weights @ x + self.bias
        # (4) x~_k = sum_j beta_jk h_j
        copy = self.output @ f(a) + self.offset
        # The same for C samples, in the k-th of which x_k is what it was when last trusted.
        change = (trusted - value) / self.half
        own = jnp.eye(len(x))
        exchanged = x[None] + own * change[None]
        # A sum, since a matrix product of this size would keep the loop around it from being one function.
        h_k = f(a[None] + change[:, None] * self.weights.T)
        copies = (self.output[None] * h_k[:, None]).sum(axis=2) + self.offset[None]
        residual = Residual(
            time=sample.time,
            value=jnp.where(self.watched, (x - copy) * self.half, 0.0),
            cov=self.cov,
            measured=value,
            expected=jnp.where(self.watched, (own * copies).sum(axis=1) * self.half + self.center, trusted),
            noise=(own * self.cov).sum(axis=1),
            valid=sample.fresh & self.watched,
            born=sample.born,
            extra=jnp.where(self.watched[None], (exchanged - copies) * self.half[None], 0.0),
        )
        return residual, _Work(value, trusted)

    def update(self, pending: _Work, trust: Trust) -> Float[Array, " C"]:
        return jnp.where(trust.measured, pending.value, pending.trusted)
