"""Covariances of an extended Kalman filter inside a compiled step: few states, sums instead of LAPACK."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jax import lax
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
    Measurements that are not `taken` change nothing.
    """
    shift = jnp.zeros_like(mean)
    for i in range(len(r)):
        shift, cov = _one(shift, cov, rows[i], innovation[i], r[i], taken[i])
    return mean + shift, (cov + cov.T) / 2


def correct_many(
    mean: Float[Array, " n"],
    cov: Float[Array, "n n"],
    rows: Float[Array, "M n"],
    innovation: Float[Array, " M"],
    r: Float[Array, " M"],
    taken: Bool[Array, " M"],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """The same in a loop, for dozens of measurements. `innovation` is of a mean of zero: filters that estimate the
    errors of one nominal state share it.
    """

    def one(now: tuple[Array, Array], measurement: tuple[Array, ...]) -> tuple[tuple[Array, Array], None]:
        return _one(*now, *measurement), None

    (mean, cov), _ = lax.scan(one, (mean, cov), (rows, innovation, r, taken))
    return mean, (cov + cov.T) / 2


def _one(
    mean: Float[Array, " n"],
    cov: Float[Array, "n n"],
    row: Float[Array, " n"],
    innovation: Float[Array, ""],
    r: Float[Array, ""],
    take: Bool[Array, ""],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """One measurement; `innovation` is of a mean of zero."""
    ph = (cov * row[None]).sum(axis=1)
    s = (ph * row).sum() + r
    # K = P Hᵀ / (H P Hᵀ + R)
    k = jnp.where(take, ph / s, 0.0)
    # P⁺ = (I - K H) P (I - K H)ᵀ + K R Kᵀ = P - K H P - P Hᵀ Kᵀ + K S Kᵀ
    after = cov - k[:, None] * ph[None] - ph[:, None] * k[None] + s * k[:, None] * k[None]
    return mean + k * (innovation - (row * mean).sum()), after
