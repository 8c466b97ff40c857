"""Inertial navigation with satellites, tightly coupled: the innovation of every pseudorange and range rate."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Sample, Trust
from sensorfault.logs.epochs import Epoch
from sensorfault.numerics import alignment
from sensorfault.numerics.alignment import ALIGNED, MOVING
from sensorfault.numerics.gnss.position import LEAST
from sensorfault.numerics.ins_error import OFFSETS, POS, corrected
from sensorfault.numerics.kalman import correct_many
from sensorfault.stages.residual import left_out
from sensorfault.stages.residual.ins_belief import Belief, aligned, begun, nothing, predicted
from sensorfault.stages.residual.sight_lines import Lines, clock_jump, sight_lines, unit
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise, Grade


class _Work(NamedTuple):
    prior: Belief
    sample: Sample
    lines: Lines
    innovation: Float[Array, " C"]
    blind: Bool[Array, ""]
    size: Float[Array, " C"]  # of the residuals, in their standard deviations


class InsGnss(eqx.Module):
    """Error-state extended Kalman filter in ECEF of 17 states (`numerics.ins_error`). Wang et al. 2023, (1)-(9).

    Channels are the pseudoranges [m] of S satellites, and behind them their Dopplers [Hz] if `rates`, with residuals in
    their own units; the sample's block is an `Epoch`. The nominal state goes with the rows of the inertial unit, its
    covariance `parts` times between two epochs. Without them it is a filter of position and velocity. It begins by
    least squares, and takes its heading from its course. `system`: of each satellite, 0 for those whose clock the
    receiver's offset refers to; others have an offset of their own. `wheel` and `aside`: standard deviations of speed
    by the wheels and of what a wheeled vehicle moves to the side or up [m/s], used where the epoch has the former.

    `bank`: the innovation of a satellite is against a filter that never took that satellite in (leave one out).
    """

    grade: Grade
    noise: ElevationNoise | CarrierNoise
    rate_sigma: Float[Array, ""]  # of range rates [m/s]
    wheel: Float[Array, ""]
    aside: Float[Array, ""]
    system: tuple[int, ...] = eqx.field(static=True)
    rates: bool = eqx.field(static=True, default=False)
    bank: bool = eqx.field(static=True, default=False)
    suspect: float = eqx.field(static=True, default=0.4)
    parts: int = eqx.field(static=True, default=2)

    @property
    def states(self) -> int:
        return OFFSETS + max(self.system, default=0)

    def init(self) -> Belief:
        return nothing(self.states, len(self.system) if self.bank else 0)

    def evaluate(self, belief: Belief, sample: Sample) -> tuple[Residual, _Work]:
        satellites = len(self.system)
        prior, blind = predicted(belief, sample.block, self.grade, self.parts)
        lines = sight_lines(prior, sample, self.system, self.noise, self.rate_sigma if self.rates else None)
        own, there = unit(satellites, self.rates), lines.there
        z = jnp.where(there, sample.value / own - lines.expected, 0.0)
        prior, z = clock_jump(prior, lines, z, satellites)
        if self.bank:
            value, cov = left_out.leave_one_out(prior, lines.rows, z, lines.variance)
        else:
            value, cov = z, lines.rows @ prior.cov @ lines.rows.T + jnp.diag(lines.variance)
        residual = Residual(
            time=sample.time,
            value=jnp.where(there, value, 0.0) * own,
            cov=jnp.where(there[:, None] & there[None], cov, jnp.eye(len(there))) * own[:, None] * own[None],
            measured=sample.value,
            expected=jnp.where(there, sample.value - value * own, sample.value),
            noise=lines.variance * own**2,
            valid=there & (prior.phase >= MOVING),
            born=sample.born,
        )
        size = jnp.abs(value) / jnp.sqrt((jnp.eye(len(there)) * cov).sum(axis=1))
        return residual, _Work(prior, sample, lines, z, blind, jnp.where(there, size, 0.0))

    def update(self, pending: _Work, trust: Trust) -> Belief:
        prior, sample, lines, innovation, blind, size = pending
        nowhere = prior.phase < MOVING
        there = lines.there
        # beginning, it takes what there is: nobody can be accused yet
        taken = there & (trust.measured | nowhere)
        mean, start = jnp.zeros(self.states), prior
        if self.bank:
            mean, start = left_out.without(prior, there & ~taken, size, self.suspect)
        aid, speeds, spread, ready = self._wheels(prior, sample.block)
        rows = jnp.concatenate([lines.rows, aid])
        z = jnp.concatenate([innovation, speeds])
        variance = jnp.concatenate([lines.variance, spread]) * jnp.where(nowhere, alignment.COARSE, 1.0)
        error, cov = correct_many(mean, start.cov, rows, z, variance, jnp.concatenate([taken, ready & ~nowhere]))
        apart, covs = start.apart, start.covs
        if self.bank:
            apart, covs = left_out.corrected(start, rows, z, variance, taken, ready)
            apart = apart - error[None]
        nav, instruments = corrected(prior.nav, prior.own, error)
        after = start._replace(
            nav=nav,
            own=instruments,
            cov=cov,
            apart=apart,
            covs=covs,
            time=sample.time,
            refused=(2 * taken.sum() < there.sum()) & (prior.phase >= MOVING),
        )
        found = (
            nowhere
            & (there[: len(self.system)].sum() >= LEAST + max(self.system, default=0))
            & (jnp.sqrt((error[POS] ** 2).sum()) < alignment.FOUND_M)
        )
        return aligned(begun(after, found), blind, self.grade)

    def _wheels(
        self, prior: Belief, epoch: Epoch
    ) -> tuple[Float[Array, "3 n"], Float[Array, "3"], Float[Array, "3"], Bool[Array, "3"]]:
        """Speed ahead by the wheels, and none to the side or up: rows, innovations, variances, and whether there."""
        speed, by = alignment.forward(prior.nav.attitude, prior.nav.velocity)
        rows = jnp.concatenate([by, jnp.zeros((3, self.states - 6))], axis=1)
        there = jnp.isfinite(epoch.ahead) & (prior.phase == ALIGNED)
        # z = s - Cᵀ v, the error with its sign turned
        measured = jnp.where(jnp.arange(3) == 0, jnp.where(there, epoch.ahead, 0.0), 0.0)
        spread = jnp.stack([self.wheel, self.aside, self.aside]) ** 2
        return -rows, measured - speed, spread, jnp.broadcast_to(there, (3,))
