"""Two channels with irregular fixes, holes and a gap, and what a part says of each valid sample."""

import jax
import jax.numpy as jnp
import numpy as np

from sensorfault.core.types import Residual

SIGMA = np.array([0.5, 2.0])


class Log:
    """T samples: times about 1 s apart, values that wander and then drift, a share of holes, one long gap."""

    def __init__(self, seed: int, rows: int = 150, holes: float = 0.2, gap_s: float = 0.0) -> None:
        rng = np.random.default_rng(seed)
        self.time = np.cumsum(rng.uniform(0.9, 1.3, rows)) + np.where(np.arange(rows) > rows // 3, gap_s, 0.0)
        ramp = np.maximum(self.time - self.time[rows // 2], 0.0)
        self.value = (rng.standard_normal((rows, 2)) + 0.2 * ramp[:, None]) * SIGMA
        self.valid = rng.random((rows, 2)) >= holes

    def seen(self, c: int, k: int, start: float = -np.inf) -> np.ndarray:
        """Rows up to k, from time `start`, in which channel c is valid."""
        rows = np.arange(k + 1)
        return rows[self.valid[: k + 1, c] & (self.time[: k + 1] >= start)]


@jax.jit
def _scores(statistic, time, value, valid):
    def one(state, row):
        now, x, good = row
        nil = jnp.zeros(2)
        seen = Residual(now, x, jnp.diag(jnp.asarray(SIGMA**2)), x, nil, nil, good, nil > 1)
        score, pending = statistic.evaluate(state, seen)
        return pending, jnp.where(score.valid, score.value, jnp.nan)

    return jax.lax.scan(one, statistic.init(), (time, value, valid))[1]


def scores(statistic, log: Log) -> np.ndarray:
    """The score of each channel after every sample, NaN where it has none; what is not valid is poison."""
    value = np.where(log.valid, log.value, np.nan)
    return np.asarray(_scores(statistic, jnp.asarray(log.time), jnp.asarray(value), jnp.asarray(log.valid)))
