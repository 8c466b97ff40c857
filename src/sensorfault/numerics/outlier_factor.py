"""Local outlier factor of new points against a fixed history."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from sensorfault.numerics.neighbours import in_rows, nearest_in_order, shares

TINY = 1e-10  # added to a mean reach, against division by zero with more than k equal points (as scikit-learn)


def density(reach: Float[Any, "*s"]) -> Float[Any, "*s"]:
    """lrd, the local reachability density: one over the mean reach of the k neighbours. NumPy or JAX."""
    # (12) lrd = 1 / mean reach
    return 1 / (reach + TINY)


class LocalDensity(eqx.Module):
    """Local density of a history at each of its N points, in ascending order if they have one feature.

    The points stand feature by feature, so that distances are computed several at a time. `near`: of each point how far
    it is to its k-th neighbour (the k-distance), and its local reachability density.
    """

    points: Float[Array, "F N"]
    near: Float[Array, "N 2"]
    k: int = eqx.field(static=True)

    def outlier_factor(self, asked: Float[Array, "C F"]) -> Float[Array, " C"]:
        """LOF of each point asked for, none of which is of the history: about 1 inside it, more outside.

        Breunig et al. 2000, as Wang et al. 2023 use it, equations (10)-(13). It equals scikit-learn's
        `-LocalOutlierFactor(k, novelty=True).score_samples`: of points equally far exactly k are neighbours.
        """
        found: Float[Array, " C"]
        if len(self.points) == 1:
            found = jax.vmap(self._alone)(asked[:, 0])
            return found
        box = jnp.stack([self.points.min(axis=1), self.points.max(axis=1)], axis=1)
        points, near = in_rows(self.points, jnp.inf), in_rows(self.near.T, 0.0)
        # one point at a time stays in the processor's cache
        found = lax.map(lambda one: _factor(near, *shares(points, box, one, self.k)), asked)
        return found

    def _alone(self, one: Float[Array, ""]) -> Float[Array, ""]:
        index, distance = nearest_in_order(self.points[0], one, self.k)
        return _factor(self.near[index].T, jnp.full(self.k, 1 / self.k), distance)


def _factor(near: Float[Array, "2 *s"], share: Float[Array, "*s"], distance: Float[Array, "*s"]) -> Float[Array, ""]:
    # (11) reach(p, q) = max(kdist(q), d(p, q))
    reach = jnp.where(share > 0, share * jnp.maximum(near[0], distance), 0.0)
    # (13) LOF = mean lrd of the neighbours / lrd
    factor: Float[Array, ""] = (share * near[1]).sum() / density(reach.sum())
    return factor
