"""Principal components against scikit-learn's."""

import numpy as np
import pytest
from sklearn.decomposition import PCA

from sensorfault.calibration.scaling import Scaling
from sensorfault.training.pca import fit_pca


@pytest.mark.parametrize(("channels", "components"), [(6, 3), (6, 1), (4, 3), (3, 3), (2, 3)])
def test_reconstruction_is_scikit_learns(channels: int, components: int) -> None:
    rng = np.random.default_rng(channels)
    train, unseen = (rng.standard_normal((n, channels)) @ rng.uniform(-1, 1, (channels, channels)) for n in (80, 20))
    fitted = fit_pca(train, Scaling.of(train, np.ones(channels, bool)), components)
    center, half = (train.max(axis=0) + train.min(axis=0)) / 2, np.ptp(train, axis=0) / 2
    theirs = PCA(min(components, channels)).fit((train - center) / half)
    for value in (train, unseen):
        x = (value - center) / half
        hidden = x @ np.asarray(fitted.weights).T + np.asarray(fitted.bias)
        copy = hidden @ np.asarray(fitted.output).T + np.asarray(fitted.offset)
        np.testing.assert_allclose(copy, theirs.inverse_transform(theirs.transform(x)), atol=1e-10)
    assert fitted.activation == "identity"
    left = (train - center) / half - theirs.inverse_transform(theirs.transform((train - center) / half))
    np.testing.assert_allclose(fitted.cov, np.cov(left * half, rowvar=False), atol=1e-10)


def test_an_unwatched_channel_carries_no_weight() -> None:
    rng = np.random.default_rng(1)
    value = rng.standard_normal((50, 4)) @ rng.uniform(-1, 1, (4, 4))
    watched = np.array([True, True, False, True])
    fitted = fit_pca(value, Scaling.of(value, watched), 2)
    assert np.abs(np.asarray(fitted.weights)[:, 2]).max() < 1e-12
    assert np.abs(np.asarray(fitted.output)[2]).max() < 1e-12
    alone = fit_pca(value[:, watched], Scaling.of(value[:, watched], np.ones(3, bool)), 2)
    np.testing.assert_allclose(np.asarray(fitted.cov)[watched][:, watched], alone.cov, atol=1e-12)
    assert float(fitted.cov[2, 2]) == 1.0
