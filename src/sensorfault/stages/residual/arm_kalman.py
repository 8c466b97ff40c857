"""Kalman filter on a two-joint arm: what its rates and angles should be under the torques of its drives."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked
from sensorfault.numerics.kalman import carried, correct
from sensorfault.vehicles.two_link import TwoLink

START = (1.0, 1.0, 0.1, 0.1)  # standard deviations of the first rates [rad/s] and angles [rad]
IGNORANCE = 100.0  # of the accelerations under a torque that nobody knows [rad/s^2]
SHARP = 4.0  # settled: the innovations' variances are no more than so many times the sensors'


class Belief(NamedTuple):
    """What the filter believes: rates and angles, and the torques that moved them last."""

    mean: Float[Array, "4"]  # [rad/s, rad]
    cov: Float[Array, "4 4"]
    torque: Float[Array, "2"]  # [N m]
    known: Bool[Array, ""]  # whether both torques are of the sample before
    time: Float[Array, ""]  # [s]
    received: Float[Array, ""]  # when a sensor was last taken in [s]
    alive: Bool[Array, ""]
    settled: Bool[Array, ""]  # whether it has known the arm about as well as the sensors do


class _Work(NamedTuple):
    prior: Belief
    sample: Sample
    innovation: Float[Array, "4"]
    there: Bool[Array, "4"]


class ArmKalman(eqx.Module):
    """Extended Kalman filter whose state (two rates, two angles) is measured directly; the residual is the innovation.

    It begins at the first sample with all four measured, tests nothing until it has settled, a sample or two later, and
    begins anew after a gap in the clock, or a silence of all sensors, of more than `gap_s`. Without a torque the last
    one stands, and nothing certain is said of the rates.
    """

    arm: TwoLink
    q: Float[Array, "4"]  # diagonal of Q for one second
    r: Float[Array, "4"]  # diagonal of R
    gap_s: Float[Array, ""]
    outputs: tuple[int, ...] = eqx.field(static=True)  # columns: rates, then angles
    torques: tuple[int, ...] = eqx.field(static=True)
    channels: int = eqx.field(static=True)

    def init(self) -> Belief:
        no, never = jnp.zeros((), bool), jnp.asarray(NEVER, float)
        return Belief(jnp.zeros(4), jnp.eye(4), jnp.zeros(2), no, never, never, no, no)

    def evaluate(self, belief: Belief, sample: Sample) -> tuple[Residual, _Work]:
        prior = self._predict(belief, sample.time)
        there = picked(sample.fresh, self.outputs) & prior.alive
        innovation = jnp.where(there, picked(sample.value, self.outputs) - prior.mean, 0.0)
        # S = P + R, since H = I
        s = prior.cov + jnp.diag(self.r)
        settled = prior.settled | (prior.alive & (jnp.diagonal(s) <= SHARP * self.r).all())
        to = (jnp.arange(self.channels)[:, None] == jnp.asarray(self.outputs)[None]).astype(float)
        rest = jnp.where(to.sum(axis=1) > 0, 0.0, 1.0)
        residual = Residual(
            time=sample.time,
            value=to @ innovation,
            cov=carried(to, s) + jnp.diag(rest),
            measured=sample.value,
            expected=jnp.where((rest == 0) & prior.alive, to @ prior.mean, sample.value),
            noise=to @ self.r + rest,
            valid=to @ (there & settled).astype(float) > 0,
            born=sample.born,
        )
        return residual, _Work(prior._replace(settled=settled), sample, innovation, there)

    def update(self, pending: _Work, trust: Trust) -> Belief:
        prior, sample, innovation, there = pending
        believed = picked(trust.measured, self.outputs)
        mean, cov = correct(prior.mean, prior.cov, jnp.eye(4), innovation, self.r, there & believed)
        begins = ~prior.alive & believed.all()
        taken = jnp.where(prior.alive, (there & believed).any(), begins)
        now = picked(trust.measured, self.torques)
        return Belief(
            mean=jnp.where(begins, picked(sample.value, self.outputs), mean),
            cov=jnp.where(prior.alive, cov, jnp.diag(jnp.asarray(START) ** 2)),
            torque=jnp.where(now, picked(sample.value, self.torques), prior.torque),
            known=now.all(),
            time=sample.time,
            received=jnp.where(taken, sample.time, prior.received),
            alive=prior.alive | begins,
            settled=prior.settled,
        )

    def _predict(self, belief: Belief, time: Float[Array, ""]) -> Belief:
        dt = time - belief.time
        good = belief.alive & (dt >= 0) & (time - belief.received <= self.gap_s)
        dt = jnp.where(good, dt, 0.0)
        # x(k|k-1) = f(x(k-1|k-1), u),  F = ∂f/∂x
        mean = self.arm.ahead(belief.mean, belief.torque, dt)
        f = jax.jacfwd(self.arm.ahead)(belief.mean, belief.torque, dt)
        pushed = jnp.where(belief.known, 0.0, (IGNORANCE * dt) ** 2) * jnp.asarray([1.0, 1.0, 0.0, 0.0])
        # P(k|k-1) = F P Fᵀ + Q
        cov = carried(f, belief.cov) + jnp.diag(self.q * dt + pushed)
        return belief._replace(mean=mean, cov=cov, alive=good, settled=belief.settled & good)
