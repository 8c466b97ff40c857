"""Local outlier factor of new points against a history that stays as it is."""

import sensorfault._jax  # isort: skip  # noqa: F401

from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.neighbours import nearest

TINY = 1e-10  # added to a mean reach, lest a history with more than k equal points divide by nought (scikit-learn's)


def density(reach: Float[Any, "*s k"]) -> Float[Any, "*s"]:
    """lrd, the local reachability density: one over the mean reach of the k neighbours. NumPy or JAX."""
    # (12) lrd = 1 / mean reach
    return 1 / (reach.mean(axis=-1) + TINY)


class LocalDensity(eqx.Module):
    """How dense a history lies at each of its N points, in ascending order where they have one feature.

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
        index, distance = nearest(self.points, asked, self.k)
        near = self.near[index]
        # (11) reach(p, q) = max(kdist(q), d(p, q))
        own: Float[Array, " C"] = density(jnp.maximum(near[..., 0], distance))
        # (13) LOF = mean lrd of the neighbours / lrd
        return near[..., 1].mean(axis=-1) / own
