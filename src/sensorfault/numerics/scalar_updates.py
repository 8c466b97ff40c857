"""Kalman corrections by many measurements, one after the other, as a loop: for a filter of a dozen states and more."""

import sensorfault._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float


def correct(
    mean: Float[Array, " n"],
    cov: Float[Array, "n n"],
    rows: Float[Array, "M n"],
    innovation: Float[Array, " M"],
    r: Float[Array, " M"],
    taken: Bool[Array, " M"],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """In Joseph's form; `innovation` is of a mean of zero, so that filters of one nominal state share it.

    What is not `taken` changes nothing.
    """

    def one(
        now: tuple[Array, Array], measurement: tuple[Array, Array, Array, Array]
    ) -> tuple[tuple[Array, Array], None]:
        mean, cov = now
        h, z, variance, take = measurement
        ph = (cov * h[None]).sum(axis=1)
        s = (ph * h).sum() + variance
        # K = P Hᵀ / S
        k = jnp.where(take, ph / s, 0.0)
        mean = mean + k * (z - (h * mean).sum())
        # P⁺ = (I - K H) P (I - K H)ᵀ + K R Kᵀ = P - K H P - P Hᵀ Kᵀ + K S Kᵀ
        cov = cov - k[:, None] * ph[None] - ph[:, None] * k[None] + s * k[:, None] * k[None]
        return (mean, cov), None

    (mean, cov), _ = lax.scan(one, (mean, cov), (rows, innovation, r, taken))
    return mean, (cov + cov.T) / 2
