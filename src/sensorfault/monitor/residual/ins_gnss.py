"""Inertial navigation with satellites, tightly coupled: the innovation of every pseudorange and range rate."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.logs.epochs import Epoch
from sensorfault.numerics import alignment
from sensorfault.numerics.alignment import ALIGNED, MOVING, NOWHERE, UNSEEN
from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S
from sensorfault.numerics.gnss.sight import distance, turned
from sensorfault.numerics.ins_error import CLOCK, OFFSETS, POS, Instruments, corrected, transition, upward
from sensorfault.numerics.scalar_updates import correct
from sensorfault.numerics.strapdown import Navigation, Rows, advance
from sensorfault.types import NEVER, Residual, Sample, Trust
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise, Grade

JUMP_M = 50.0  # every pseudorange further off than this and six of its sigmas: the receiver's clock has jumped
LOST_M = 1000.0  # with a position no better than this it begins anew
NEAR_EARTH_M = 1e5  # further from its surface a filter has run away, whatever it thinks of itself
LEAST = 4  # satellites that tell a position
HOLES = 0.2  # share of the time without inertial rows in which no attitude is taken
DOUBT = 1.5  # by which standard deviations grow after an epoch in which most were refused


class _Belief(NamedTuple):
    nav: Navigation
    own: Instruments
    cov: Float[Array, "n n"]
    apart: Float[Array, "B n"]  # what each filter of the bank estimates as the errors of the common state
    covs: Float[Array, "B n n"]
    time: Float[Array, ""]  # [s]
    phase: Float[Array, ""]
    refused: Bool[Array, ""]  # most of the last epoch was
    out: Bool[Array, " B"]  # of the bank, whose satellite the last epoch left out


class _Lines(NamedTuple):
    expected: Float[Array, " C"]
    rows: Float[Array, "C n"]
    variance: Float[Array, " C"]
    there: Bool[Array, " C"]


class _Work(NamedTuple):
    prior: _Belief
    sample: Sample
    lines: _Lines
    innovation: Float[Array, " C"]
    blind: Bool[Array, ""]
    size: Float[Array, " C"]  # of the residuals, in their standard deviations


class InsGnss(eqx.Module):
    """Error-state extended Kalman filter in ECEF of 17 states (`numerics.ins_error`). Wang et al. 2023, (1)-(9).

    Channels are the pseudoranges [m] of S satellites, and behind them their Dopplers [Hz] if `rates`, told as
    residuals in their own units; the sample's block is an `Epoch`. The nominal state goes with the rows of the inertial
    unit, its covariance `parts` times between two epochs. Without them it is a filter of position and velocity.
    It begins by least squares, and takes its heading from its course. `system`: of each satellite, 0 for those whose
    clock the receiver's is told against; others have an offset. `wheel` and `aside`: standard deviations of speed by
    the wheels and of what a wheeled vehicle moves to the side or up [m/s], used where the epoch has the former.

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

    def init(self) -> _Belief:
        n, members = self.states, len(self.system) if self.bank else 0
        zero = jnp.zeros(())
        return _Belief(
            Navigation(jnp.eye(3), jnp.zeros(3), jnp.array([alignment.EARTH_M, 0.0, 0.0])),
            Instruments(jnp.zeros(3), jnp.zeros(3), zero, zero, jnp.zeros(n - OFFSETS)),
            alignment.nowhere(n),
            jnp.zeros((members, n)),
            jnp.zeros((members, n, n)),
            jnp.asarray(NEVER, float),
            jnp.asarray(UNSEEN, float),
            jnp.zeros((), bool),
            jnp.zeros(members, bool),
        )

    def evaluate(self, belief: _Belief, sample: Sample) -> tuple[Residual, _Work]:
        epoch: Epoch = sample.block
        prior, blind = self._predict(belief, epoch)
        lines = self._lines(prior, sample, epoch)
        prior, innovation = self._clock_jump(prior, sample, lines)
        if self.bank:
            each = lines.rows.reshape(-1, len(self.system), self.states)  # ranges, rates
            value = innovation - (each * prior.apart[None]).sum(axis=2).reshape(-1)
            spread = (each * (prior.covs[None] * each[:, :, None]).sum(axis=3)).sum(axis=2)
            cov = jnp.diag(spread.reshape(-1) + lines.variance)
        else:
            value = innovation
            cov = lines.rows @ prior.cov @ lines.rows.T + jnp.diag(lines.variance)
        unit = self._unit()
        there = lines.there
        residual = Residual(
            time=sample.time,
            value=jnp.where(there, value, 0.0) * unit,
            cov=jnp.where(there[:, None] & there[None], cov, jnp.eye(len(there))) * unit[:, None] * unit[None],
            measured=sample.value,
            expected=jnp.where(there, sample.value - value * unit, sample.value),
            noise=lines.variance * unit**2,
            valid=there & (prior.phase >= MOVING),
            born=sample.born,
        )
        size = jnp.abs(value) / jnp.sqrt((jnp.eye(len(there)) * cov).sum(axis=1))
        return residual, _Work(prior, sample, lines, innovation, blind, jnp.where(there, size, 0.0))

    def update(self, pending: _Work, trust: Trust) -> _Belief:
        prior, sample, lines, innovation, blind, size = pending
        nowhere = prior.phase < MOVING
        there = lines.there
        ranges = there[: len(self.system)]
        # beginning, it takes what there is: nobody can be accused yet
        taken = there & (trust.measured | nowhere)
        start, start_cov, apart, covs, out = self._without(prior, there & ~taken, size)
        aid, speeds, spread, ready = self._wheels(prior, sample.block)
        rows = jnp.concatenate([lines.rows, aid])
        z = jnp.concatenate([innovation, speeds])
        variance = jnp.concatenate([lines.variance, spread])
        error, cov = correct(start, start_cov, rows, z, variance, jnp.concatenate([taken, ready & ~nowhere]))
        if self.bank:
            own = jnp.arange(len(there)) % len(self.system) == jnp.arange(len(self.system))[:, None]
            each = jnp.concatenate([taken[None] & ~own, jnp.broadcast_to(ready, (len(own), 3))], axis=1)
            apart, covs = jax.vmap(lambda m, p, t: correct(m, p, rows, z, variance, t))(apart, covs, each)
            apart = apart - error[None]
        nav, instruments = corrected(prior.nav, prior.own, error)
        few = taken & there
        after = prior._replace(
            nav=nav,
            own=instruments,
            cov=cov,
            apart=apart,
            covs=covs,
            time=sample.time,
            out=out,
            refused=(2 * few.sum() < there.sum()) & (prior.phase >= MOVING),
        )
        found = (
            nowhere
            & (ranges.sum() >= LEAST + max(self.system, default=0))
            & (jnp.sqrt((error[POS] ** 2).sum()) < alignment.FOUND_M)
        )
        return self._aligned(self._begun(after, found), blind)

    def _predict(self, belief: _Belief, epoch: Epoch) -> tuple[_Belief, Bool[Array, ""]]:
        """Navigation by the rows of the inertial unit, covariances by its stretches."""
        n, nowhere = self.states, belief.phase < MOVING
        reckons = belief.phase == ALIGNED
        per = -(-epoch.dt.shape[0] // self.parts)
        more = per * self.parts - epoch.dt.shape[0]
        rows = Rows(epoch.gyro - belief.own.gyro, epoch.force - belief.own.force, epoch.dt, epoch.ok)
        cut = jax.tree.map(
            lambda x: jnp.concatenate([x, jnp.zeros((more, *x.shape[1:]), x.dtype)]).reshape(
                self.parts, per, *x.shape[1:]
            ),
            rows,
        )

        nav, phi, q = belief.nav, jnp.eye(n), jnp.zeros((n, n))
        for k in range(self.parts):
            nav, way = advance(nav, jax.tree.map(lambda x, k=k: x[k], cut), reckons)
            step = transition(nav, way, n)
            # products of 17 by 17 in earnest, not as sums: in a campaign they are five times as fast
            phi = step if k == 0 else step @ phi
            q = (0.0 if k == 0 else step @ q @ step.T) + jnp.diag(self.grade.added(way, n))
        doubt = jnp.where(belief.refused, DOUBT**2, 1.0)

        def carried(cov: Array) -> Array:
            after = phi @ (cov * doubt) @ phi.T + q
            return (after + after.T) / 2

        first = alignment.nowhere(n)
        clock = belief.own.clock + belief.own.drift * epoch.dt.sum()
        placed = jnp.isfinite(epoch.place).all(axis=1)
        begins = (belief.phase == UNSEEN) & placed.any()
        still = belief.nav._replace(
            position=jnp.where(begins, alignment.under(epoch.place, placed), belief.nav.position)
        )
        prior = belief._replace(
            phase=jnp.where(begins, float(NOWHERE), belief.phase),
            nav=jax.tree.map(lambda new, old: jnp.where(nowhere, old, new), nav, still),
            own=belief.own._replace(clock=jnp.where(nowhere, belief.own.clock, clock)),
            cov=jnp.where(nowhere, first, carried(belief.cov)),
            apart=(phi[None] * belief.apart[:, None]).sum(axis=2),
            covs=jax.vmap(carried)(belief.covs),
        )
        return prior, jnp.where(epoch.ok, 0.0, epoch.dt).sum() > HOLES * epoch.dt.sum()

    def _lines(self, prior: _Belief, sample: Sample, epoch: Epoch) -> _Lines:
        """What each satellite should show, and how that changes with the errors of the state."""
        satellites, n = len(self.system), self.states
        placed = jnp.isfinite(epoch.place).all(axis=1)
        up = upward(prior.nav.position)
        place = jnp.where(placed[:, None], epoch.place, prior.nav.position + 2e7 * up)
        speed = jnp.where(jnp.isfinite(epoch.speed), epoch.speed, 0.0)
        long, rate = jax.jvp(distance, (prior.nav.position, place), (prior.nav.velocity, speed))
        away = turned(place, long / LIGHT_M_S) - prior.nav.position
        sight = away / jnp.sqrt((away**2).sum(axis=1))[:, None]
        elevation = jnp.arcsin(jnp.clip((sight * up[None]).sum(axis=1), -1.0, 1.0))
        system = jnp.asarray(self.system)[:, None] == 1 + jnp.arange(n - OFFSETS)[None]
        offset = (system * prior.own.offsets[None]).sum(axis=1)
        fresh = sample.fresh[:satellites] & placed
        none, column = jnp.zeros((satellites, 3)), jnp.ones((satellites, 1))
        # z = u δr - δc: errors are estimate minus truth
        rows = [none, none, sight, none, none, -column, 0 * column, -system.astype(float)]
        expected, variance, there = (
            [long + prior.own.clock + offset],
            [self.noise.variance(elevation, epoch.cn0)],
            [fresh],
        )
        lines = [jnp.concatenate(rows, axis=1)]
        if self.rates:
            # z = u δv - δd
            lines.append(jnp.concatenate([none, sight, none, none, none, 0 * column, -column, 0.0 * system], axis=1))
            expected.append(rate + prior.own.drift)
            variance.append(self.rate_sigma**2 * jnp.ones(satellites))
            moving = jnp.isfinite(epoch.speed).all(axis=1) & (prior.phase >= MOVING)
            there.append(sample.fresh[satellites:] & placed & moving)
        return _Lines(*(jnp.concatenate(parts) for parts in (expected, lines, variance, there)))

    def _unit(self) -> Float[Array, " C"]:
        """Of metres and metres a second in the channels' own units: a Doppler is -f / c of a range rate."""
        ranges = jnp.ones(len(self.system))
        return jnp.concatenate([ranges, -L1_HZ / LIGHT_M_S * ranges]) if self.rates else ranges

    def _clock_jump(self, prior: _Belief, sample: Sample, lines: _Lines) -> tuple[_Belief, Float[Array, " C"]]:
        """If every pseudorange is far off, so is the clock: by as much as the one that is least."""
        satellites = len(self.system)
        z = jnp.where(lines.there, sample.value / self._unit() - lines.expected, 0.0)
        ranges, there = z[:satellites], lines.there[:satellites]
        rows = lines.rows[:satellites]
        s = ((rows[:, None] * prior.cov[None]).sum(axis=2) * rows).sum(axis=1) + lines.variance[:satellites]
        far = jnp.where(there, jnp.abs(ranges) - 6 * jnp.sqrt(s), jnp.inf)
        jumped = (far.min() > JUMP_M) & (there.sum() >= LEAST) & (prior.phase >= MOVING)
        least = jnp.abs(ranges) + jnp.where(there, 0.0, jnp.inf)
        by = jnp.where(least == least.min(), ranges, 0.0).sum() * jumped
        clock = (jnp.arange(self.states) == CLOCK).astype(float)
        apart = 1 - clock * jumped
        new = jnp.where(jumped, JUMP_M**2, 0.0) * jnp.diag(clock)

        def loose(cov: Array) -> Array:
            return cov * apart[:, None] * apart[None] + new

        prior = prior._replace(
            own=prior.own._replace(clock=prior.own.clock + by),
            cov=loose(prior.cov),
            apart=prior.apart * apart[None],
            covs=jax.vmap(loose)(prior.covs),
        )
        moved = jnp.concatenate([by * there, jnp.zeros(len(z) - satellites)])
        return prior, z - moved

    def _without(
        self, prior: _Belief, refused: Bool[Array, " C"], size: Float[Array, " C"]
    ) -> tuple[Float[Array, " n"], Float[Array, "n n"], Float[Array, "B n"], Float[Array, "B n n"], Bool[Array, " B"]]:
        """A satellite that is newly left out has spoilt every filter but that without it: all go on from that one."""
        nothing = jnp.zeros(self.states)
        if not self.bank:
            return nothing, prior.cov, prior.apart, prior.covs, prior.out
        satellites = len(self.system)
        out = refused.reshape(-1, satellites).any(axis=0)
        worst = jnp.where(out & ~prior.out, size.reshape(-1, satellites).max(axis=0), 0.0)
        found = worst.max() > 0
        mine = (jnp.arange(satellites) == jnp.argmax(worst)).astype(float)
        spoilt = found & (size.reshape(-1, satellites).max(axis=0) < self.suspect * worst.max())
        mean = (mine[:, None] * prior.apart).sum(axis=0)
        cov = (mine[:, None, None] * prior.covs).sum(axis=0)
        return (
            jnp.where(found, mean, nothing),
            jnp.where(found, cov, prior.cov),
            jnp.where(spoilt[:, None], mean[None], prior.apart),
            jnp.where(spoilt[:, None, None], cov[None], prior.covs),
            out,
        )

    def _wheels(
        self, prior: _Belief, epoch: Epoch
    ) -> tuple[Float[Array, "3 n"], Float[Array, "3"], Float[Array, "3"], Bool[Array, "3"]]:
        """Speed ahead by the wheels, and none to the side or up: rows, innovations, variances, and whether there."""
        speed, by = alignment.forward(prior.nav.attitude, prior.nav.velocity)
        rows = jnp.concatenate([by, jnp.zeros((3, self.states - 6))], axis=1)
        there = jnp.isfinite(epoch.ahead) & (prior.phase == ALIGNED)
        # z = s - Cᵀ v, the error with its sign turned
        measured = jnp.where(jnp.arange(3) == 0, jnp.where(there, epoch.ahead, 0.0), 0.0)
        spread = jnp.stack([self.wheel, self.aside, self.aside]) ** 2
        return -rows, measured - speed, spread, jnp.broadcast_to(there, (3,))

    def _begun(self, after: _Belief, found: Bool[Array, ""]) -> _Belief:
        """With a position found in one epoch a filter of position and velocity begins; lost, it begins anew."""
        first = alignment.moving(self.states)
        vague = jnp.stack([after.cov[i, i] for i in (6, 7, 8)]).max() > LOST_M**2
        height = jnp.sqrt((after.nav.position**2).sum()) - alignment.EARTH_M
        away = (after.phase >= MOVING) & ~(jnp.abs(height) < NEAR_EARTH_M)
        lost = (after.phase >= MOVING) & vague | away
        again = jnp.where(away, float(UNSEEN), float(NOWHERE))
        still = Navigation(jnp.eye(3), jnp.zeros(3), after.nav.position)
        fresh = found | lost | (after.phase < MOVING)
        return after._replace(
            nav=jax.tree.map(lambda new, old: jnp.where(fresh, new, old), still, after.nav),
            own=after.own._replace(drift=jnp.where(fresh, 0.0, after.own.drift)),
            cov=jnp.where(fresh, first, after.cov),
            apart=jnp.where(fresh, 0.0, after.apart),
            covs=jnp.where(fresh, first[None], after.covs),
            phase=jnp.where(found, float(MOVING), jnp.where(lost, again, after.phase)),
        )

    def _aligned(self, after: _Belief, blind: Bool[Array, ""]) -> _Belief:
        """Once its course is known, and the inertial unit heard, it navigates by it."""
        ready = (after.phase == MOVING) & ~blind & alignment.course_known(after.nav, after.cov)
        biases = self.grade.gyro_bias, self.grade.force_bias
        nav, cov = alignment.along_course(after.nav, after.cov, *biases)
        covs = jax.vmap(lambda p: alignment.along_course(after.nav, p, *biases)[1])(after.covs)
        return after._replace(
            nav=jax.tree.map(lambda new, old: jnp.where(ready, new, old), nav, after.nav),
            cov=jnp.where(ready, cov, after.cov),
            covs=jnp.where(ready, covs, after.covs),
            phase=jnp.where(ready, float(ALIGNED), after.phase),
        )
