"""Kalman filter of an aircraft's height: what the receiver and the barometer should say of it."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked
from sensorfault.numerics.kalman import carried, correct

GRAVITY = 9.80665  # [m/s^2]
START = (5.0, 300.0, 0.3)  # standard deviations of the first vertical speed, barometer's bias, accelerometer's bias
UNFELT = 4.0  # variance that a second without the inertial unit adds to the climb [(m/s)^2]
WARM = 5  # heights taken in before anything is tested


class _Belief(NamedTuple):
    mean: Float[Array, "4"]  # height [m], climb [m/s], biases of the barometer [m] and of the accelerometer [m/s^2]
    cov: Float[Array, "4 4"]
    push: Float[Array, ""]  # upward acceleration, as last measured [m/s^2]
    time: Float[Array, ""]  # [s]
    received: Float[Array, ""]  # when a height was last taken in [s]
    known: Int[Array, ""]  # heights taken in, WARM at most
    felt: Bool[Array, ""]  # whether `push` was measured
    alive: Bool[Array, ""]


class _Work(NamedTuple):
    prior: _Belief
    sample: Sample
    innovation: Float[Array, " O"]
    there: Bool[Array, " O"]


class HeightKalman(eqx.Module):
    """State: height, climb, the barometer's bias and, with an inertial unit, the accelerometer's; the companion EKF of
    Wang et al., whose innovation has the variance S. The residual is the innovation.

    `outputs`: columns of the height, then of what there is of climb and barometric height; `rows` is H, with the sign
    of the climb. `inertial`: columns of pitch (nose up), roll (right wing down) and the accelerometer's x (forward), y
    and z, or nothing: then the climb is a random walk. `below`: 1 if y points right and z down, -1 if left and up. The
    filter begins at a height, and anew after `gap_s` without one.
    """

    rows: Float[Array, "O 4"]
    q: Float[Array, "3"]  # a second adds so much to the variance of climb [(m/s)^2] and of both biases
    r: Float[Array, " O"]
    gap_s: Float[Array, ""]
    below: Float[Array, ""]
    outputs: tuple[int, ...] = eqx.field(static=True)
    inertial: tuple[int, ...] = eqx.field(static=True, default=())

    def init(self) -> _Belief:
        nothing, never = jnp.zeros(()), jnp.asarray(NEVER, float)
        none = jnp.zeros((), bool)
        return _Belief(jnp.zeros(4), jnp.eye(4), nothing, never, never, jnp.zeros((), int), none, none)

    def evaluate(self, belief: _Belief, sample: Sample) -> tuple[Residual, _Work]:
        prior = self._predict(belief, sample.time)
        there = picked(sample.fresh, self.outputs) & prior.alive
        expected = (self.rows * prior.mean[None]).sum(axis=1)
        innovation = jnp.where(there, picked(sample.value, self.outputs) - expected, 0.0)
        # S = H P Hᵀ + R
        s = carried(self.rows, prior.cov) + jnp.diag(self.r)
        to = (jnp.arange(sample.value.size)[:, None] == jnp.asarray(self.outputs)[None]).astype(float)
        mine = to.sum(axis=1) > 0
        rest = jnp.where(mine, 0.0, 1.0)
        residual = Residual(
            time=sample.time,
            value=to @ innovation,
            cov=carried(to, s) + jnp.diag(rest),
            measured=sample.value,
            expected=jnp.where(mine & prior.alive, to @ expected, sample.value),
            noise=to @ self.r + rest,
            valid=to @ (there & (prior.known >= WARM)).astype(float) > 0,
            born=sample.born,
        )
        return residual, _Work(prior, sample, innovation, there)

    def update(self, pending: _Work, trust: Trust) -> _Belief:
        prior, sample, innovation, there = pending
        believed = picked(trust.measured, self.outputs)
        mean, cov = correct(prior.mean, prior.cov, self.rows, innovation, self.r, there & believed)
        begins = ~prior.alive & believed[0]
        none = jnp.zeros(())
        first = jnp.stack([sample.value[self.outputs[0]], none, none, none])
        spread = jnp.concatenate([self.r[:1], jnp.asarray(START) ** 2])
        if not self.inertial:
            spread = spread * jnp.asarray([1.0, 1.0, 1.0, 0.0])
        taken = believed[0] & (prior.alive | begins)
        known = jnp.where(prior.alive, prior.known, 0)
        push, felt = self._push(sample, trust)
        return _Belief(
            mean=jnp.where(begins, first, mean),
            cov=jnp.where(prior.alive, cov, jnp.diag(spread)),
            push=push,
            felt=felt,
            time=sample.time,
            received=jnp.where(taken, sample.time, prior.received),
            known=jnp.where(taken, jnp.minimum(known + 1, WARM), known),
            alive=prior.alive | begins,
        )

    def _predict(self, belief: _Belief, time: Float[Array, ""]) -> _Belief:
        dt = time - belief.time
        good = belief.alive & (dt >= 0) & (time - belief.received <= self.gap_s)
        dt = jnp.where(good, dt, 0.0)
        one, none, half = jnp.ones(()), jnp.zeros(()), dt**2 / 2
        felt = belief.felt.astype(float)
        # h⁺ = h + v Δt + (a - b) Δt²/2,  v⁺ = v + (a - b) Δt
        f = jnp.stack(
            [
                jnp.stack([one, dt, none, -half * felt]),
                jnp.stack([none, one, none, -dt * felt]),
                jnp.stack([none, none, one, none]),
                jnp.stack([none, none, none, one]),
            ]
        )
        pushed = jnp.stack([half, dt, none, none]) * belief.push
        mean = (f * belief.mean[None]).sum(axis=1) + pushed
        climb, baro, force = self.q
        climb = climb if not self.inertial else jnp.where(belief.felt, climb, UNFELT)
        corner = climb * jnp.stack([jnp.stack([dt**3 / 3, half]), jnp.stack([half, dt])])
        rest = jnp.diag(jnp.stack([baro, force]) * dt)
        q = jnp.concatenate(
            [
                jnp.concatenate([corner, jnp.zeros((2, 2))], axis=1),
                jnp.concatenate([jnp.zeros((2, 2)), rest], axis=1),
            ]
        )
        # P(k|k-1) = F P Fᵀ + Q
        return belief._replace(mean=mean, cov=carried(f, belief.cov) + q, alive=good)

    def _push(self, sample: Sample, trust: Trust) -> tuple[Float[Array, ""], Bool[Array, ""]]:
        """Upward acceleration of the specific force, turned by roll and pitch, and whether it is known."""
        if not self.inertial:
            return jnp.zeros(()), jnp.zeros((), bool)
        fresh = picked(sample.fresh, self.inertial)
        good = picked(sample.present, self.inertial).all() & (picked(trust.measured, self.inertial) | ~fresh).all()
        pitch, roll, x, y, z = picked(sample.value, self.inertial)
        # a = f_x sin θ - (f_y sin φ + f_z cos φ) cos θ - g
        side = self.below * (y * jnp.sin(roll) + z * jnp.cos(roll))
        up = x * jnp.sin(pitch) - side * jnp.cos(pitch) - GRAVITY
        return jnp.where(good, up, 0.0), good
