"""Square-root cubature Kalman filter inside a compiled step: any f and h, no Jacobian, no LAPACK, a handful of states.

Source: I. Arasaratnam & S. Haykin, Cubature Kalman filters, IEEE TAC 54(6), 2009, appendix. All sums are of deviations
from the mean, so a spread of centimetres survives a state in radians.
"""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.gaussian import precision


class Seen(NamedTuple):
    """What should be measured. `dx`, `dz`: deviations of the 2n points of state and measurement, over √2n.

    P = dx dxᵀ, P_zz = dz dzᵀ (without R), P_xz = dx dzᵀ.
    """

    expected: Float[Array, " M"]
    dx: Float[Array, "n p"]
    dz: Float[Array, "M p"]


def triangular(wide: Float[Array, "n k"]) -> Float[Array, "n n"]:
    """Lower L with L Lᵀ = A Aᵀ and no negative diagonal: Gram and Schmidt on the rows, in the modified order."""
    rows, size = [wide[i] for i in range(len(wide))], len(wide)
    lower = [[jnp.zeros(())] * size for _ in range(size)]
    for i in range(size):
        # L_ii = |a_i|,  L_ji = a_j · a_i / L_ii,  a_j ← a_j - L_ji a_i / L_ii
        # divided out before squaring, so that 1e-200 does not underflow
        scale = jnp.maximum(jnp.abs(rows[i]).max(), 1e-300)
        length = scale * jnp.sqrt(((rows[i] / scale) ** 2).sum())
        unit = jnp.where(length > 0, rows[i] / jnp.where(length > 0, length, 1.0), 0.0)
        lower[i][i] = length
        for j in range(i + 1, size):
            lower[j][i] = (rows[j] * unit).sum()
            rows[j] = rows[j] - lower[j][i] * unit
    return jnp.stack([jnp.stack(row) for row in lower])


def points(mean: Float[Array, " n"], root: Float[Array, "n n"]) -> Float[Array, "p n"]:
    """The 2n cubature points mean ± √n S_i, of equal weight."""
    away = jnp.sqrt(jnp.asarray(mean.size, float)) * root.T
    return mean[None] + jnp.concatenate([away, -away])


def _deviations(at: Float[Array, "p n"]) -> tuple[Float[Array, " n"], Float[Array, "n p"]]:
    """Mean of the points, and their deviations over √2n."""
    mean = at[0] + (at - at[0][None]).mean(axis=0)  # mean of differences, so that a common offset is not rounded
    return mean, (at - mean[None]).T / jnp.sqrt(jnp.asarray(len(at), float))


def predict(
    f: Callable[[Float[Array, " n"]], Float[Array, " n"]],
    mean: Float[Array, " n"],
    root: Float[Array, "n n"],
    q_root: Float[Array, "n n"],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """Mean and root of P after x ← f(x) + w, w of covariance `q_root` `q_root`ᵀ. Xu et al. 2023, (7)-(11)."""
    ahead, spread = _deviations(jax.vmap(f)(points(mean, root)))
    return ahead, triangular(jnp.concatenate([spread, q_root], axis=1))


def observe(
    h: Callable[[Float[Array, " n"]], Float[Array, " M"]], mean: Float[Array, " n"], root: Float[Array, "n n"]
) -> Seen:
    """Expected measurement by h; the points are drawn again around the prediction. Xu et al. 2023, (12)-(17)."""
    at = points(mean, root)
    expected, dz = _deviations(jax.vmap(h)(at))
    return Seen(expected, (at - mean[None]).T / jnp.sqrt(jnp.asarray(len(at), float)), dz)


def bent(seen: Seen, at_mean: Float[Array, " M"]) -> Float[Array, " M"]:
    """Variance of each measurement from the curvature of h, which the points miss; `at_mean` is h(mean).

    Small beside R unless the spread is a good part of the way over which h bends: a filter that has been lost for long
    would else believe its first fixes too much. The second-order term of a Gaussian filter (Jazwinski 1970, 9.3).
    """
    n = len(seen.dx)
    # c_i = (z_i⁺ + z_i⁻) / 2 - h(x) = n h'' σ² / 2,  Var = Σ (h'' σ²)² / 2 = Σ 2 (c_i / n)²
    both = jnp.sqrt(jnp.asarray(2.0 * n)) * (seen.dz[:, :n] + seen.dz[:, n:]) / 2
    c = both + (seen.expected - at_mean)[:, None]
    return 2 * ((c / n) ** 2).sum(axis=1)


def correct(
    mean: Float[Array, " n"],
    seen: Seen,
    innovation: Float[Array, " M"],
    r: Float[Array, " M"],
    taken: Bool[Array, " M"],
) -> tuple[Float[Array, " n"], Float[Array, "n n"]]:
    """Mean and root of P after measurements with independent noise of variance r; what is not `taken` changes nothing.

    Xu et al. 2023, (18)-(20), in square-root form.
    """
    dz = jnp.where(taken[:, None], seen.dz, 0.0)
    r_root = jnp.where(taken, jnp.sqrt(r), 0.0)
    # K = P_xz P_zz⁻¹
    s = (dz[:, None, :] * dz[None]).sum(axis=2) + jnp.diag(jnp.where(taken, r, 1.0))
    cross = (seen.dx[:, None, :] * dz[None]).sum(axis=2)
    gain = (cross[:, :, None] * precision(s, taken)[None]).sum(axis=1)
    mean = mean + (gain * jnp.where(taken, innovation, 0.0)[None]).sum(axis=1)
    # P⁺ = (dx - K dz)(dx - K dz)ᵀ + K R Kᵀ
    rest = seen.dx - (gain[:, :, None] * dz[None]).sum(axis=1)
    return mean, triangular(jnp.concatenate([rest, gain * r_root[None]], axis=1))
