"""Pseudoranges and range rates as a GNSS/INS filter takes them: what they should be, and how its errors show."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Sample
from sensorfault.logs.epochs import Epoch
from sensorfault.numerics.alignment import MOVING
from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S
from sensorfault.numerics.gnss.position import LEAST
from sensorfault.numerics.gnss.sight import distance, turned
from sensorfault.numerics.ins_error import CLOCK, OFFSETS, upward
from sensorfault.stages.residual.ins_belief import Belief
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise

JUMP_M = 50.0  # every pseudorange further off than this and six of its sigmas: the receiver's clock has jumped


class Lines(NamedTuple):
    """All pseudoranges [m], behind them range rates [m/s] if wanted: C in all."""

    expected: Float[Array, " C"]
    rows: Float[Array, "C n"]
    variance: Float[Array, " C"]
    there: Bool[Array, " C"]


def unit(satellites: int, rates: bool) -> Float[Array, " C"]:
    """Of metres and metres a second in the channels' own units: a Doppler is -f / c of a range rate."""
    ranges = jnp.ones(satellites)
    return jnp.concatenate([ranges, -L1_HZ / LIGHT_M_S * ranges]) if rates else ranges


def sight_lines(
    prior: Belief,
    sample: Sample,
    system: tuple[int, ...],
    noise: ElevationNoise | CarrierNoise,
    rate_sigma: Float[Array, ""] | None,
) -> Lines:
    """What each satellite should show, and how that changes with the errors of the state; no rates without a sigma."""
    epoch: Epoch = sample.block
    satellites, n = len(system), len(prior.cov)
    placed = jnp.isfinite(epoch.place).all(axis=1)
    up = upward(prior.nav.position)
    place = jnp.where(placed[:, None], epoch.place, (prior.nav.position + 2e7 * up)[None])
    speed = jnp.where(jnp.isfinite(epoch.speed), epoch.speed, 0.0)
    here, moving = prior.nav.position[None], prior.nav.velocity[None]
    long, rate = jax.jvp(distance, (here, place), (moving, speed))
    away = turned(place, long / LIGHT_M_S) - here
    sight = away / jnp.sqrt((away**2).sum(axis=1))[:, None]
    elevation = jnp.arcsin(jnp.clip((sight * up[None]).sum(axis=1), -1.0, 1.0))
    others = (jnp.asarray(system)[:, None] == 1 + jnp.arange(n - OFFSETS)[None]).astype(float)
    offset = (others * prior.own.offsets[None]).sum(axis=1)
    none, column = jnp.zeros((satellites, 3)), jnp.ones((satellites, 1))
    # z = u δr - δc: errors are estimate minus truth
    rows = [none, none, sight, none, none, -column, 0 * column, -others]
    ranges = Lines(
        long + prior.own.clock + offset,
        jnp.concatenate(rows, axis=1),
        noise.variance(elevation, epoch.cn0),
        sample.fresh[:satellites] & placed,
    )
    if rate_sigma is None:
        return ranges
    # z = u δv - δd
    rows = [none, sight, none, none, none, 0 * column, -column, 0 * others]
    timed = jnp.isfinite(epoch.speed).all(axis=1) & (prior.phase >= MOVING)
    rates = Lines(
        rate + prior.own.drift,
        jnp.concatenate(rows, axis=1),
        rate_sigma**2 * jnp.ones(satellites),
        sample.fresh[satellites:] & placed & timed,
    )
    return Lines(*(jnp.concatenate(both) for both in zip(ranges, rates, strict=True)))


def clock_jump(
    prior: Belief, lines: Lines, z: Float[Array, " C"], satellites: int
) -> tuple[Belief, Float[Array, " C"]]:
    """If every pseudorange is far off, the clock is off by the smallest of them. Returns what is left of z."""
    ranges, there = z[:satellites], lines.there[:satellites]
    rows = lines.rows[:satellites]
    s = ((rows[:, None] * prior.cov[None]).sum(axis=2) * rows).sum(axis=1) + lines.variance[:satellites]
    far = jnp.where(there, jnp.abs(ranges) - 6 * jnp.sqrt(s), jnp.inf)
    jumped = (far.min() > JUMP_M) & (there.sum() >= LEAST) & (prior.phase >= MOVING)
    least = jnp.abs(ranges) + jnp.where(there, 0.0, jnp.inf)
    by = jnp.where(least == least.min(), ranges, 0.0).sum() * jumped.astype(float)
    clock = (jnp.arange(len(prior.cov)) == CLOCK).astype(float)
    apart = jnp.where(jumped, 1 - clock, 1.0)
    new = jnp.where(jumped, JUMP_M**2, 0.0) * jnp.diag(clock)

    def loose(cov: Array) -> Array:
        return cov * apart[:, None] * apart[None] + new

    prior = prior._replace(
        own=prior.own._replace(clock=prior.own.clock + by),
        cov=loose(prior.cov),
        apart=prior.apart * apart[None],
        covs=jax.vmap(loose)(prior.covs),
    )
    moved = jnp.concatenate([jnp.where(there, by, 0.0), jnp.zeros(len(z) - satellites)])
    return prior, z - moved
