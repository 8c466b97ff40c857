"""Covariances of an extended Kalman filter inside a compiled step: a handful of states, sums instead of LAPACK."""

import sensorfault._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float


def carried(f: Float[Array, "m n"], cov: Float[Array, "n n"]) -> Float[Array, "m m"]:
    """F P Fᵀ, symmetric."""
    fp = (f[:, :, None] * cov[None]).sum(axis=1)
    fpf = (fp[:, None, :] * f[None]).sum(axis=2)
    return (fpf + fpf.T) / 2


def correct(
    mean: Float[Array, " n"],
    cov: Float[Array, "n n"],
    rows: Float[Array, "M n"],
    innovation: Float[Array, " M"],
    r: Float[Array, " M"],
    taken: Bool[Array, " M"],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """M measurements with independent noise of variance r, one after the other in Joseph's form.

    `innovation` = measured - expected of the mean given, `rows` = H there: together they do what one joint update does.
    What is not `taken` changes nothing.
    """
    prior = mean
    for i in range(len(r)):
        row = rows[i]
        ph = cov @ row
        # K = P Hᵀ / (H P Hᵀ + R)
        k = jnp.where(taken[i], ph / (row @ ph + r[i]), 0.0)
        mean = mean + k * (innovation[i] - row @ (mean - prior))
        # P⁺ = (I - K H) P (I - K H)ᵀ + K R Kᵀ
        half = cov - k[:, None] * ph[None]
        cov = half - (half @ row)[:, None] * k[None] + r[i] * k[:, None] * k[None]
    return mean, (cov + cov.T) / 2
