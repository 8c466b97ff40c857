"""A bank of GNSS/INS filters about one nominal state, each without one of the satellites (leave one out)."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.kalman import correct_many
from sensorfault.stages.residual.ins_belief import Belief


def leave_one_out(
    prior: Belief, rows: Float[Array, "C n"], z: Float[Array, " C"], variance: Float[Array, " C"]
) -> tuple[Float[Array, " C"], Float[Array, "C C"]]:
    """Innovation of each measurement against the filter without its satellite, and their variances."""
    each = rows.reshape(-1, *prior.apart.shape)  # ranges, rates
    value = z - (each * prior.apart[None]).sum(axis=2).reshape(-1)
    spread = (each * (prior.covs[None] * each[:, :, None]).sum(axis=3)).sum(axis=2)
    return value, jnp.diag(spread.reshape(-1) + variance)


def without(
    prior: Belief, refused: Bool[Array, " C"], size: Float[Array, " C"], suspect: float
) -> tuple[Float[Array, " n"], Belief]:
    """A satellite that is newly left out has spoilt every filter that used it: all continue from the one without it.

    `size` of the residuals, in their standard deviations; a filter whose own is at least `suspect` of the worst stays.
    Returns what is then estimated as the errors of the nominal state, and the belief.
    """
    satellites, states = prior.apart.shape
    out = refused.reshape(-1, satellites).any(axis=0)
    worst = jnp.where(out & ~prior.out, size.reshape(-1, satellites).max(axis=0), 0.0)
    found = worst.max() > 0
    mine = (jnp.arange(satellites) == jnp.argmax(worst)).astype(float)
    spoilt = found & (size.reshape(-1, satellites).max(axis=0) < suspect * worst.max())
    mean = (mine[:, None] * prior.apart).sum(axis=0)
    cov = (mine[:, None, None] * prior.covs).sum(axis=0)
    return jnp.where(found, mean, jnp.zeros(states)), prior._replace(
        cov=jnp.where(found, cov, prior.cov),
        apart=jnp.where(spoilt[:, None], mean[None], prior.apart),
        covs=jnp.where(spoilt[:, None, None], cov[None], prior.covs),
        out=out,
    )


def corrected(
    start: Belief,
    rows: Float[Array, "M n"],
    z: Float[Array, " M"],
    variance: Float[Array, " M"],
    taken: Bool[Array, " C"],
    aided: Bool[Array, " A"],
) -> tuple[Float[Array, "B n"], Float[Array, "B n n"]]:
    """Each filter with what was taken of other satellites, and with the A aids behind them."""
    members = len(start.apart)
    own = (jnp.arange(len(taken)) % members)[None] == jnp.arange(members)[:, None]
    each = jnp.concatenate([taken[None] & ~own, jnp.broadcast_to(aided, (members, len(aided)))], axis=1)
    done: tuple[Array, Array] = jax.vmap(lambda m, p, t: correct_many(m, p, rows, z, variance, t))(
        start.apart, start.covs, each
    )
    return done
