"""w-tests and averaged innovations of satellites that come and go, against sums of inverses in NumPy."""

from collections.abc import Iterator

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy import stats

from laws.strict import strict
from sensorfault.calibration.chi_square import chi_square
from sensorfault.core.types import Residual, Score
from sensorfault.numerics.blocks import enough
from sensorfault.stages.statistic.averaged_baarda_w import AveragedBaardaW
from sensorfault.stages.statistic.averaged_innovation import AveragedInnovation
from sensorfault.stages.statistic.baarda_w import BaardaW
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.stages.statistic.standardised import Standardised
from sensorfault.stages.statistic.windowed import Windowed
from sensorfault.stages.threshold.chi_square import ChiSquare

__all__ = ["strict"]

C, WINDOW_S = 5, 9.5
SLOTS = enough(WINDOW_S, 1.0)


class Sky:
    """Correlated innovations with the covariance that changes from epoch to epoch, holes, and one rise."""

    def __init__(self, seed: int, rows: int = 80, holes: float = 0.3) -> None:
        rng = np.random.default_rng(seed)
        root = rng.standard_normal((rows, C, C)) + 2 * np.eye(C)
        self.cov = root @ np.swapaxes(root, 1, 2)
        self.value = (root @ rng.standard_normal((rows, C, 1)))[..., 0]
        self.valid = rng.random((rows, C)) >= holes
        self.valid[20] = False
        self.time = np.arange(rows) + 1e5
        self.born = np.zeros((rows, C), bool)
        self.born[40, 2] = True

    def residuals(self) -> Residual:
        nil = np.zeros_like(self.value)
        poisoned = np.where(self.valid, self.value, np.nan)
        cov = np.where(self.valid[:, :, None] & self.valid[:, None], self.cov, np.nan)
        diagonal = np.where(np.eye(C, dtype=bool), self.cov, cov)
        return Residual(
            *map(jnp.asarray, (self.time, poisoned, diagonal, nil, nil, nil, self.valid, self.born)), (), self.born
        )


@jax.jit
def result(statistic, rows: Residual) -> Score:
    def one(state, row):
        score, pending = statistic.evaluate(state, row)
        return pending, score

    return jax.lax.scan(one, statistic.init(), rows)[1]


@jax.jit
def limits(part: ChiSquare, rows: Residual, score: Score) -> jax.Array:
    return jax.vmap(lambda *seen: part.evaluate((), seen)[0])(rows, score)


def averages(sky: Sky, window: int) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
    """Row, who is there, V⁻¹ and z̄ over the last so many epochs."""
    for k in range(len(sky.time)):
        here = np.flatnonzero(sky.valid[k])
        if not len(here):
            continue
        total, pull = np.zeros((C, C)), np.zeros(C)
        for j in range(max(k - window + 1, 0), k + 1):
            there = sky.valid[j]
            inverse = np.zeros((C, C))
            inverse[np.ix_(there, there)] = np.linalg.inv(sky.cov[j][np.ix_(there, there)])
            one = inverse @ np.where(there, sky.value[j], 0.0)
            if j < 40 <= k:
                inverse[2] = inverse[:, 2] = one[2] = 0.0
            total += inverse
            pull += one
        matrix = total[np.ix_(here, here)]
        yield k, here, matrix, np.linalg.solve(matrix, pull[here])


def test_the_w_test_is_baardas() -> None:
    sky = Sky(1)
    score = result(BaardaW(), sky.residuals())
    for k, here, inverse, z in averages(sky, 1):
        expected = np.abs(inverse @ z) / np.sqrt(np.diag(inverse))
        np.testing.assert_allclose(score.value[k, here], expected, rtol=1e-9)
    np.testing.assert_array_equal(score.valid, sky.valid)


def test_the_averaged_w_test_of_each() -> None:
    sky = Sky(2)
    alone = result(AveragedBaardaW(jnp.asarray(WINDOW_S), C, SLOTS), sky.residuals())
    for k, here, inverse, mean in averages(sky, 10):
        w = np.abs(inverse @ mean) / np.sqrt(np.diag(inverse))
        np.testing.assert_allclose(alone.value[k, here], w, rtol=1e-9)
    np.testing.assert_array_equal(alone.valid, sky.valid)


def test_the_averaged_innovation_of_each_counts_only_what_came() -> None:
    sky = Sky(3, holes=0.4)
    part = Windowed(AveragedInnovation(), jnp.asarray(WINDOW_S), jnp.asarray(30.0), C, SLOTS, early=True)
    score = result(part, sky.residuals())
    for c in (0, 1):
        for k in np.flatnonzero(sky.valid[:, c]):
            mine = np.flatnonzero(sky.valid[: k + 1, c])
            mine = mine[mine > k - 10]
            s = sky.cov[mine, c, c]
            mean = (sky.value[mine, c] / s).sum() / (1 / s).sum()
            np.testing.assert_allclose(score.value[k, c], abs(mean) * np.sqrt((1 / s).sum()), rtol=1e-9)
    np.testing.assert_array_equal(score.valid, sky.valid)


def test_the_limit_of_chi_square_follows_the_number_of_satellites() -> None:
    """Of white Gaussian innovations a share alpha is over it, with five satellites as with two."""
    sky, alpha = Sky(4, rows=20_000), 0.05
    score = result(Mahalanobis(), sky.residuals())
    limit = limits(chi_square(alpha, C), sky.residuals(), score)
    many = sky.valid.sum(axis=1)
    np.testing.assert_allclose(limit[:, 0] ** 2, np.where(many, stats.chi2.ppf(1 - alpha, np.maximum(many, 1)), 0.0))
    for m in range(2, C + 1):
        over = np.asarray(score.value > limit)[many == m, 0]
        assert over.mean() == pytest.approx(alpha, abs=5 * np.sqrt(alpha * 3 / over.size))


def test_a_standardised_distance_has_one_limit_for_all() -> None:
    sky = Sky(5, rows=20_000)
    score = result(Standardised(Mahalanobis()), sky.residuals())
    many, value = sky.valid.sum(axis=1), np.asarray(score.value)[:, 0]
    for m in range(2, C + 1):
        assert np.mean(value[many == m] > stats.norm.isf(0.05)) == pytest.approx(0.05, abs=0.015)
    plain = np.asarray(result(Mahalanobis(), sky.residuals()).value)[:, 0]
    for m in (1, 3, 5):
        ranked = np.argsort(plain[many == m])
        assert (np.diff(value[many == m][ranked]) >= 0).all()
        exact = stats.norm.isf(stats.chi2.sf(plain[many == m] ** 2, m))
        if m == 5:  # where limits are, less than a tenth of a deviation off
            far = (exact > 1) & (exact < 4)
            np.testing.assert_allclose(value[many == m][far], exact[far], atol=0.1)
