"""What a GNSS/INS filter believes: carried on by inertial rows, begun from nothing, aligned along its course."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER
from sensorfault.logs.epochs import Epoch
from sensorfault.numerics import alignment
from sensorfault.numerics.alignment import ALIGNED, MOVING, NOWHERE, UNSEEN
from sensorfault.numerics.ins_error import OFFSETS, Instruments, transition
from sensorfault.numerics.strapdown import Navigation, Rows, advance
from sensorfault.vehicles.train import Grade

LOST_M = 1000.0  # with a position no better than this it begins anew
NEAR_EARTH_M = 1e5  # further from its surface a filter has run away, whatever it thinks of itself
HOLES = 0.2  # share of the time without inertial rows in which no attitude is taken
DOUBT = 1.5  # by which standard deviations grow after an epoch in which most were refused


class Belief(NamedTuple):
    """One nominal state, its covariance, and a bank of B filters that each leave one satellite out, or none (B = 0)."""

    nav: Navigation
    own: Instruments
    cov: Float[Array, "n n"]
    apart: Float[Array, "B n"]  # what each filter of the bank estimates as the errors of the common state
    covs: Float[Array, "B n n"]
    time: Float[Array, ""]  # [s]
    phase: Float[Array, ""]
    refused: Bool[Array, ""]  # most of the last epoch was
    out: Bool[Array, " B"]  # of the bank, whose satellite the last epoch left out


def nothing(states: int, members: int) -> Belief:
    """Before the first satellite."""
    zero = jnp.zeros(())
    return Belief(
        Navigation(jnp.eye(3), jnp.zeros(3), jnp.array([alignment.EARTH_M, 0.0, 0.0])),
        Instruments(jnp.zeros(3), jnp.zeros(3), zero, zero, jnp.zeros(states - OFFSETS)),
        alignment.nowhere(states),
        jnp.zeros((members, states)),
        jnp.zeros((members, states, states)),
        jnp.asarray(NEVER, float),
        jnp.asarray(UNSEEN, float),
        jnp.zeros((), bool),
        jnp.zeros(members, bool),
    )


def predicted(belief: Belief, epoch: Epoch, grade: Grade, parts: int) -> tuple[Belief, Bool[Array, ""]]:
    """Navigation by the rows of the inertial unit, covariances by `parts` stretches of them; whether it was blind."""
    n, nowhere = len(belief.cov), belief.phase < MOVING
    reckons = belief.phase == ALIGNED
    nav, phi, q = belief.nav, jnp.eye(n), jnp.zeros((n, n))
    for k, rows in enumerate(_stretches(belief, epoch, parts)):
        nav, way = advance(nav, rows, reckons)
        step = transition(nav, way, n)
        # products of 17 by 17 in earnest, not as sums: in a campaign they are five times as fast
        phi = step if k == 0 else step @ phi
        q = (0.0 if k == 0 else step @ q @ step.T) + jnp.diag(grade.added(way, n))
    doubt = jnp.where(belief.refused, DOUBT**2, 1.0)

    def carried(cov: Array) -> Array:
        after = phi @ (cov * doubt) @ phi.T + q
        return (after + after.T) / 2

    clock = belief.own.clock + belief.own.drift * epoch.dt.sum()
    placed = jnp.isfinite(epoch.place).all(axis=1)
    begins = (belief.phase == UNSEEN) & placed.any()
    still = belief.nav._replace(position=jnp.where(begins, alignment.under(epoch.place, placed), belief.nav.position))
    prior = belief._replace(
        phase=jnp.where(begins, float(NOWHERE), belief.phase),
        nav=jax.tree.map(lambda new, old: jnp.where(nowhere, old, new), nav, still),
        own=belief.own._replace(clock=jnp.where(nowhere, belief.own.clock, clock)),
        cov=jnp.where(nowhere, alignment.nowhere(n), carried(belief.cov)),
        apart=(phi[None] * belief.apart[:, None]).sum(axis=2),
        covs=jax.vmap(carried)(belief.covs),
    )
    return prior, jnp.where(epoch.ok, 0.0, epoch.dt).sum() > HOLES * epoch.dt.sum()


def _stretches(belief: Belief, epoch: Epoch, parts: int) -> list[Rows]:
    """The inertial rows without their biases, in so many stretches of the same length."""
    per = -(-epoch.dt.shape[0] // parts)
    more = per * parts - epoch.dt.shape[0]
    rows = Rows(epoch.gyro - belief.own.gyro[None], epoch.force - belief.own.force[None], epoch.dt, epoch.ok)
    cut = jax.tree.map(
        lambda x: jnp.concatenate([x, jnp.zeros((more, *x.shape[1:]), x.dtype)]).reshape(parts, per, *x.shape[1:]),
        rows,
    )
    return [jax.tree.map(lambda x, k=k: x[k], cut) for k in range(parts)]


def begun(after: Belief, found: Bool[Array, ""]) -> Belief:
    """A filter of position and velocity begins with a position found in one epoch, and begins anew when lost."""
    first = alignment.moving(len(after.cov))
    vague = jnp.stack([after.cov[i, i] for i in (6, 7, 8)]).max() > LOST_M**2
    height = jnp.sqrt((after.nav.position**2).sum()) - alignment.EARTH_M
    away = (after.phase >= MOVING) & ~(jnp.abs(height) < NEAR_EARTH_M)
    lost = (after.phase >= MOVING) & vague | away
    again = jnp.where(away, float(UNSEEN), float(NOWHERE))
    still = Navigation(jnp.eye(3), jnp.zeros(3), after.nav.position)
    fresh = found | lost | (after.phase < MOVING)
    return after._replace(
        nav=jax.tree.map(lambda new, old: jnp.where(fresh, new, old), still, after.nav),
        # a filter that was wrong has laid it on the instruments: biases of any size would carry it off again
        own=after.own._replace(**{x: jnp.where(fresh, 0.0, getattr(after.own, x)) for x in ("gyro", "force", "drift")}),
        cov=jnp.where(fresh, first, after.cov),
        apart=jnp.where(fresh, 0.0, after.apart),
        covs=jnp.where(fresh, first[None], after.covs),
        phase=jnp.where(found, float(MOVING), jnp.where(lost, again, after.phase)),
    )


def aligned(after: Belief, blind: Bool[Array, ""], grade: Grade) -> Belief:
    """Once its course is known and inertial rows arrive, it navigates by the inertial unit."""
    ready = (after.phase == MOVING) & ~blind & alignment.course_known(after.nav, after.cov)
    biases = grade.gyro_bias, grade.force_bias
    nav, cov = alignment.along_course(after.nav, after.cov, *biases)
    covs = jax.vmap(lambda p: alignment.along_course(after.nav, p, *biases)[1])(after.covs)
    return after._replace(
        nav=jax.tree.map(lambda new, old: jnp.where(ready, new, old), nav, after.nav),
        cov=jnp.where(ready, cov, after.cov),
        covs=jnp.where(ready, covs, after.covs),
        phase=jnp.where(ready, float(ALIGNED), after.phase),
    )
