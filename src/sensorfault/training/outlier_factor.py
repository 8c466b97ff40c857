"""The fixed history of a local outlier factor."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError
from sensorfault.numerics.outlier_factor import LocalDensity, density

HISTORY, NEIGHBOURS = 1000, 20  # points kept, and k


def fit_history(seen: Float[np.ndarray, "M F"], seed: int, history: int = HISTORY, k: int = NEIGHBOURS) -> LocalDensity:
    """The local density of `history` healthy features, drawn at random from all satellites and runs.

    Rows with a NaN are left out; if there are fewer than `history`, all are used.

    Raises:
        LogError: there are not more than k.
    """
    from scipy.spatial import KDTree

    known = seen[np.isfinite(seen).all(axis=1)]
    if len(known) <= k:
        raise LogError(
            f"{len(known)} healthy innovations are too few for {k} neighbours; give a longer healthy log, or a "
            "smaller k."
        )
    points = np.random.default_rng(seed).permutation(known)[:history]
    if points.shape[1] == 1:
        points = np.sort(points, axis=0)
    distance, index = KDTree(points).query(points, k + 1)
    # the k nearest other points of each point: the point itself is left out, or an equal one
    own = index == np.arange(len(points))[:, None]
    own[~own.any(axis=1), -1] = True
    distance, index = (x[~own].reshape(-1, k) for x in (distance, index))
    reach = distance[:, -1]
    near = np.column_stack([reach, density(np.maximum(reach[index], distance).mean(axis=1))])
    return LocalDensity(jnp.asarray(points.T), jnp.asarray(near), k)
