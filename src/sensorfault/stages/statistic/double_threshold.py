"""Two thresholds on each channel's innovation: a network that saw the last ones decides between them."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.columns import shifted
from sensorfault.numerics.networks.dense import Mlp
from sensorfault.stages.statistic.per_channel import each


class DoubleThreshold(eqx.Module):
    """M > `high`, or M > `low` and the network predicts an error beyond `wrong`; the score is over 1 then.

    M is the innovation in its standard deviations. The network's window is the last `window` of a channel, taken in or
    not: a slow fault shows in several that no single one shows. A reading of the test that Xu et al. 2023 compare
    with (Zhao et al., Control and Decision 35(6), 2020), whose text we do not have.
    """

    network: Mlp
    low: Float[Array, ""]
    high: Float[Array, ""]
    wrong: Float[Array, ""]
    window: int = eqx.field(static=True)
    channels: int = eqx.field(static=True)

    def init(self) -> Float[Array, "s C"]:
        return jnp.zeros((self.window, self.channels))

    def evaluate(self, last: Float[Array, "s C"], residual: Residual) -> tuple[Score, Float[Array, "s C"]]:
        own = jnp.eye(self.channels)
        now = residual.value / jnp.sqrt((own * residual.cov).sum(axis=1))
        seen = shifted(jnp.where(residual.born[None], 0.0, last), now)
        predicted = self.network(seen[:, None, :])[0]
        size = jnp.abs(now)
        score = jnp.maximum(size / self.high, jnp.minimum(size / self.low, predicted / self.wrong))
        return each(score, residual.valid), jnp.where(residual.valid[None], seen, last)

    def update(self, pending: Float[Array, "s C"], trust: Trust) -> Float[Array, "s C"]:
        return pending
