"""Principal components: the baseline of the reconstruction methods."""

import numpy as np
from jaxtyping import Float

from sensorfault.calibration.scaling import Scaling
from sensorfault.stages.residual.reconstruction import Reconstruction


def fit_pca(value: Float[np.ndarray, "N C"], scaling: Scaling, components: int = 3) -> Reconstruction:
    """Projection of healthy rows (SI, finite) on their first principal components. Jackson & Mudholkar 1979."""
    x = scaling.to_unit(value)
    mean = x.mean(axis=0)
    # x - mean = U S V', and the first rows of V' span the healthy plane
    _, _, vt = np.linalg.svd(x - mean, full_matrices=False)
    v = vt[:components]
    # x~ = mean + V V' (x - mean)
    residual = (x - mean) - (x - mean) @ v.T @ v
    return scaling.reconstruction(v, -(v @ mean), v.T, mean, "identity", residual)
