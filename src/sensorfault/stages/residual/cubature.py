"""Cubature Kalman filter of any vehicle that says how it moves and what should be measured."""

from typing import Any, NamedTuple, Protocol

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked
from sensorfault.numerics.cubature import Seen, bent, correct, observe, predict
from sensorfault.stages.residual.measurement_noise import Stated

MANY = 20.0  # rejections in a row beyond which the process noise grows no more


class Motion(Protocol):
    """A vehicle, as the filter needs it; n numbers of state, M measurements.

    `observed`: the channels measured, in the order of `expected`.
    """

    observed: tuple[int, ...]

    def start(self, sample: Sample) -> tuple[Float[Array, " n"], Float[Array, " n"], Bool[Array, ""]]:
        """State to begin with, its standard deviations, and whether this sample tells it."""
        ...

    def ahead(self, state: Float[Array, " n"], sample: Sample, dt: Float[Array, ""]) -> Float[Array, " n"]:
        """f: the state at this sample from the one `dt` [s] before."""
        ...

    def noise(
        self, state: Float[Array, " n"], spread: Float[Array, " n"], sample: Sample, dt: Float[Array, ""]
    ) -> Float[Array, " n"]:
        """Standard deviations of what f adds in `dt` [s] to a state of this `spread`."""
        ...

    def expected(self, state: Float[Array, " n"], sample: Sample) -> Float[Array, " M"]:
        """h: what should be measured."""
        ...

    def ready(self, sample: Sample) -> Bool[Array, " M"]:
        """Which of the measurements h can tell now."""
        ...

    def lost(self, state: Float[Array, " n"], spread: Float[Array, " n"]) -> Bool[Array, ""]:
        """Whether these standard deviations are too large to go on with."""
        ...


class _Belief(NamedTuple):
    mean: Float[Array, " n"]
    root: Float[Array, "n n"]  # S with S Sᵀ = P
    time: Float[Array, ""]  # [s]
    rejected: Float[Array, ""]  # measurements refused since one was last taken in
    last: Float[Array, " M"]  # measurements as they were last taken in; NEVER where none was
    received: Float[Array, " M"]  # when that was [s]
    alive: Bool[Array, ""]


class _Work(NamedTuple):
    prior: _Belief
    sample: Sample
    seen: Seen
    innovation: Float[Array, " M"]
    used: Float[Array, " M"]  # R*
    there: Bool[Array, " M"]
    again: Bool[Array, " M"]  # exact repeats


class Cubature(eqx.Module):
    """The residual is the innovation of each observed channel, with P_zz of the stated R; `noise` is the R* in use.

    `vehicle` is a Motion. `r`: stated variances of the measurements. `noise`: the R in use. `growth`: each measurement
    refused in a row makes the variance of the process larger by this share (up to 20 of them), so that a filter that
    refuses all soon trusts itself less than them. `repeated`: an exact repeat's R is so many times as large: a sensor
    that repeats itself to the last bit has likely not measured. The filter begins where the vehicle's state is
    measured. Of a measurement that was not taken in for `stale_s`, what h bends within the filter's spread counts as
    noise: else points that stand far apart would turn an uncertain state into a wrong one. Xu et al. 2023, (6)-(20),
    (30) and (31); what trust leaves out has gain 0, (33)-(35).
    """

    vehicle: Any
    r: Float[Array, " M"]
    noise: Stated
    growth: Float[Array, ""]
    repeated: Float[Array, ""]
    stale_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    states: int = eqx.field(static=True)

    def init(self) -> _Belief:
        nothing = jnp.zeros(())
        never, no = jnp.asarray(NEVER, float), jnp.zeros((), bool)
        last = jnp.full(self.r.shape, NEVER, float)
        return _Belief(jnp.zeros(self.states), jnp.eye(self.states), never, nothing, last, last, no)

    def evaluate(self, belief: _Belief, sample: Sample) -> tuple[Residual, _Work]:
        motion: Motion = self.vehicle
        prior = self._predict(belief, sample)
        seen = observe(lambda state: motion.expected(state, sample), prior.mean, prior.root)
        there = picked(sample.fresh, motion.observed) & motion.ready(sample) & prior.alive
        said = picked(sample.value, motion.observed)
        innovation = jnp.where(there, said - seen.expected, 0.0)
        stale = sample.time - prior.received > self.stale_s
        curved = jnp.where(stale, bent(seen, motion.expected(prior.mean, sample)), 0.0)
        predicted = (seen.dz**2).sum(axis=1) + curved
        used = self.noise.in_use(self.r, innovation, predicted)
        again = there & (said == prior.last)
        used = used * jnp.where(again, self.repeated, 1.0) + curved
        # P_zz
        s = (seen.dz[:, None, :] * seen.dz[None]).sum(axis=2) + jnp.diag(self.r + curved)
        at = jnp.arange(self.channels)[:, None] == jnp.asarray(motion.observed)[None]
        to = at.astype(float)
        rest = 1.0 - to.sum(axis=1)
        mine = (at & (motion.ready(sample) & prior.alive)[None]).any(axis=1)
        across = (to[:, :, None] * s[None]).sum(axis=1)  # no product of matrices: it would be a call in a small loop
        residual = Residual(
            time=sample.time,
            value=_placed(to, innovation),
            cov=(to[:, None, :] * across[None]).sum(axis=2) + jnp.diag(rest),
            measured=sample.value,
            expected=jnp.where(mine, _placed(to, jnp.where(prior.alive, seen.expected, 0.0)), sample.value),
            noise=_placed(to, used) + rest,
            valid=(at & there[None]).any(axis=1),
            born=sample.born,
        )
        return residual, _Work(prior, sample, seen, innovation, used, there, again)

    def update(self, pending: _Work, trust: Trust) -> _Belief:
        prior, sample, seen, innovation, used, there, again = pending
        motion: Motion = self.vehicle
        taken = there & picked(trust.measured, motion.observed)
        mean, root = correct(prior.mean, seen, innovation, used, taken)
        refused = (there & ~taken & ~(again & (self.repeated > 1))).sum().astype(float)
        first, spread, begins = motion.start(sample)
        begins = begins & ~prior.alive
        return _Belief(
            mean=jnp.where(begins, first, mean),
            root=jnp.where(begins, jnp.diag(spread), root),
            time=sample.time,
            rejected=jnp.where(taken.any() | begins, 0.0, jnp.minimum(prior.rejected + refused, MANY)),
            last=jnp.where(taken, picked(sample.value, motion.observed), prior.last),
            received=jnp.where(taken, sample.time, prior.received),
            alive=prior.alive | begins,
        )

    def _predict(self, belief: _Belief, sample: Sample) -> _Belief:
        motion: Motion = self.vehicle
        dt = jnp.where(belief.alive, jnp.maximum(sample.time - belief.time, 0.0), 0.0)
        before = jnp.sqrt((belief.root**2).sum(axis=1))
        q_root = jnp.diag(motion.noise(belief.mean, before, sample, dt) * (1 + self.growth) ** (belief.rejected / 2))
        mean, root = predict(lambda state: motion.ahead(state, sample, dt), belief.mean, belief.root, q_root)
        spread = jnp.sqrt((root**2).sum(axis=1))
        return belief._replace(mean=mean, root=root, alive=belief.alive & ~motion.lost(mean, spread))


def _placed(to: Float[Array, "C M"], each: Float[Array, " M"]) -> Float[Array, " C"]:
    """One number a measurement, at its channel."""
    return (to * each[None]).sum(axis=1)
