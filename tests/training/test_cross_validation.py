"""The largest error on rows left out, against a loop that does it by hand."""

import numpy as np

from sensorfault.calibration.scaling import Scaling
from sensorfault.training.cross_validation import largest_unseen_norm
from sensorfault.training.elm import fit_elm
from sensorfault.training.pca import fit_pca


def rows(seed: int = 1, length: int = 403) -> np.ndarray:
    rng = np.random.default_rng(seed)
    causes = rng.standard_normal((length, 2)) @ rng.standard_normal((2, 4))
    return causes + 0.1 * rng.standard_normal((length, 4)) + [1.0, -2.0, 0.0, 5.0]


def test_blocks_are_judged_by_what_did_not_see_them() -> None:
    value, scale = rows(), np.array([1.0, 2.0, 0.5, 1.0])
    worst, start = 0.0, 0
    for size in (81, 81, 81, 80, 80):
        rest = np.concatenate([value[:start], value[start + size :]])
        low, high = rest.min(axis=0), rest.max(axis=0)
        center, half = (low + high) / 2, (high - low) / 2
        x, unseen = (rest - center) / half, (value[start : start + size] - center) / half
        axes = np.linalg.eigh(np.cov(x.T))[1][:, -2:]
        left = (unseen - x.mean(axis=0)) @ (np.eye(4) - axes @ axes.T) * half / scale
        worst = max(worst, np.linalg.norm(left, axis=1).max())
        start += size
    found = largest_unseen_norm(value, np.ones(4, bool), lambda v, s: fit_pca(v, s, 2), scale)
    np.testing.assert_allclose(found, worst, rtol=1e-9)


def test_what_lies_outside_the_training_range_counts() -> None:
    """A network that copies errs beyond what it saw: a far row is seen for what it is by those who did not see it."""
    value = rows()
    value[200] += 8 * value.std(axis=0)
    watched = np.ones(4, bool)
    scaling = Scaling.of(value, watched)
    trained = np.sqrt(np.diag(np.asarray(fit_elm(value, scaling).cov)) / scaling.half**2).max()
    assert largest_unseen_norm(value, watched, fit_elm, scaling.half) > 10 * trained


def test_a_channel_that_is_not_watched_plays_no_part() -> None:
    value = rows()
    wild = value.copy()
    wild[:, 3] *= 1e6
    watched = np.array([True, True, True, False])
    one, other = (largest_unseen_norm(v, watched, fit_elm, np.ones(4)) for v in (value, wild))
    assert one == other
