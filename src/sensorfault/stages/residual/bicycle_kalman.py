"""Bicycle-model Kalman filter: what positions and speeds should be if the car goes where its wheels point."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked
from sensorfault.numerics.kalman import carried, correct
from sensorfault.numerics.local import east_north, moved, on_the_map, wrapped
from sensorfault.vehicles.bicycle import bicycle

LEAST_TURNING = 0.5  # below this speed a yaw rate turns the car less and less, at rest not at all [m/s]
GAP_S = 2.0  # over a longer gap of the clock nothing is predicted
START_M, MARK_S = 2.0, 2.0  # the way that gives the first heading is so long, and gone within this time
FASTEST = 100.0  # what goes faster is no way of a car [m/s]
LOST_S, LOST_AT = 10.0, 8.0  # lost: for so long no fix was taken in within so many standard deviations
START_SPREAD = (0.5, 0.5, 0.3, 2.0)  # standard deviations of the first x, y [m], heading [rad] and speed [m/s]
IGNORANCE = (2.0, 0.3)  # of an acceleration [m/s^2] and of a turn [rad/s or rad] that nothing measures
STEEPEST = 1.2  # largest angle of the front wheels [rad]


class Columns(eqx.Module):
    """Which channels say what. `position`: latitude, longitude. `velocity`: north and east, or speed alone.

    `gyro`, `accelerometer`: x, y and z, or nothing. `steering`: one channel, or nothing; with it the gyro is not used.
    """

    position: tuple[int, ...] = eqx.field(static=True)
    velocity: tuple[int, ...] = eqx.field(static=True)
    accelerometer: tuple[int, ...] = eqx.field(static=True, default=())
    gyro: tuple[int, ...] = eqx.field(static=True, default=())
    steering: tuple[int, ...] = eqx.field(static=True, default=())

    @property
    def measured(self) -> tuple[int, ...]:
        """The channels that are predicted, in the order of H."""
        return self.position + self.velocity


class Belief(NamedTuple):
    """What the filter believes, and what its next prediction needs.

    `mean`: x east and y north of the anchor [m], heading φ from east to north [rad], speed v [m/s], bias of the turn
    (of the yaw rate [rad/s] or the front wheel angle [rad]) and of the acceleration [m/s^2].
    """

    mean: Float[Array, "6"]
    cov: Float[Array, "6 6"]
    anchor: Float[Array, "2"]  # latitude, longitude of the last fix taken in [rad]
    fixed: Float[Array, ""]  # when that was [s]
    agreed: Float[Array, ""]  # when a fix last came about where it was expected [s]
    inputs: Float[Array, "2"]  # U: acceleration [m/s^2] and turn, as last measured
    known: Bool[Array, "2"]
    time: Float[Array, ""]
    alive: Bool[Array, ""]


class _Work(NamedTuple):
    prior: Belief
    sample: Sample
    way: Float[Array, "2"]  # from the anchor to the fix, east and north [m]
    rows: Float[Array, "M 6"]  # H
    innovation: Float[Array, " M"]  # Z - H Ω [m, m/s]
    s: Float[Array, "M M"]  # its covariance
    there: Bool[Array, " M"]
    dt: Float[Array, ""]  # since the sample before [s]


class BicycleKalman(eqx.Module):
    """Extended Kalman filter (18)-(22) on the kinematic bicycle (16) of Min et al. 2021, in the additive form.

    U is what the accelerometer and the gyro (or the steering wheel) said at the sample before, as in (16). Measured are
    position and speed, new fixes only; the residual is the innovation. x and y count from the last fix taken in, so
    nothing degrades far from home. The first heading is that of the first 2 m of way; after 10 s without a fix that was
    taken in and about where it was expected, or a gap of 2 s in the clock, it starts afresh: unknown meanwhile.

    A speed without direction is taken for one ahead: |v| would let the filter start from a light backwards and stay so.
    A car that backs up under such a speed looks carried until the filter has started afresh.

    The errors of a receiver that smooths are correlated over time, which a Kalman filter takes for white: `spread`
    makes the size of its innovations right, their independence is not.
    """

    columns: Columns
    forward: Float[Array, "3"]  # acceleration = forward . accelerometer
    turning: Float[Array, " t"]  # yaw rate = turning . gyro, or front wheel angle = turning . steering
    wheelbase: Float[Array, ""]  # l [m]
    q: Float[Array, "6"]  # diagonal of Q for one second
    r: Float[Array, " M"]  # diagonal of R: along, across [m^2], velocities [m^2/s^2]
    spread: Float[Array, " M"]  # of healthy innovations over what P and R say, which the gain does not use
    smooth_s: Float[Array, ""]  # time constant of a low pass on U: a receiver that smooths is late like that [s]
    late_s: Float[Array, "2"]  # how late position and velocity come behind U after that [s]
    speed_scale: Float[Array, ""]  # measured over true speed
    bias: Float[Array, "2"]  # of turn and acceleration at the start
    bias_spread: Float[Array, "2"]  # their standard deviations
    channels: int = eqx.field(static=True)

    def init(self) -> Belief:
        never = jnp.asarray(NEVER, float)
        nil, no = jnp.zeros(2), jnp.zeros(2, bool)
        return Belief(jnp.zeros(6), jnp.eye(6), nil, never, never, nil, no, never, jnp.zeros((), bool))

    def evaluate(self, belief: Belief, sample: Sample) -> tuple[Residual, _Work]:
        prior = self._predict(belief, sample.time)
        expected, rows = self.measured(prior.mean, prior.inputs), jax.jacfwd(self.measured)(prior.mean, prior.inputs)
        latitude, longitude, *velocity = picked(sample.value, self.columns.measured)
        way = east_north(latitude, longitude, prior.anchor[0], prior.anchor[1])
        here = on_the_map(latitude, longitude) & sample.fresh[self.columns.position[0]]
        here = here & sample.fresh[self.columns.position[1]] & prior.alive
        fresh = [sample.fresh[i] & prior.alive for i in self.columns.velocity]
        there = jnp.stack([here, here, *fresh])
        # Z - H Ω(k|k-1), the position along and across the heading
        turned = _turned(prior.mean[2], len(self.r))
        rows = (turned[:, :, None] * rows[None]).sum(axis=1)
        innovation = turned @ jnp.where(there, jnp.stack([*way, *velocity]) - expected, 0.0)
        # S = H P(k|k-1) Hᵀ + R
        s = (carried(rows, prior.cov) + jnp.diag(self.r)) * (self.spread[:, None] * self.spread[None])
        work = _Work(prior, sample, way, rows, innovation, s, there, sample.time - belief.time)
        return self._residual(work, turned, expected), work

    def update(self, pending: _Work, trust: Trust) -> Belief:
        prior, sample, way, rows, innovation, s, there, _ = pending
        believed = picked(trust.measured, self.columns.measured)
        fix = there[0] & believed[0] & believed[1]
        taken = jnp.concatenate([jnp.stack([fix, fix]), there[2:] & believed[2:]])
        # (20)-(22)
        mean, cov = correct(prior.mean, prior.cov, rows, innovation, self.r, taken)
        near = fix & (innovation[0] ** 2 < LOST_AT**2 * s[0, 0]) & (innovation[1] ** 2 < LOST_AT**2 * s[1, 1])
        agreed = jnp.where(near, sample.time, prior.agreed)
        lost = sample.time - agreed > LOST_S
        gone = prior._replace(
            mean=mean - jnp.where(fix, jnp.concatenate([way, jnp.zeros(4)]), 0.0),  # the fix becomes the anchor
            cov=cov,
            anchor=jnp.where(fix, picked(sample.value, self.columns.position), prior.anchor),
            fixed=jnp.where(fix, sample.time, prior.fixed),
            agreed=agreed,
            alive=~lost,
        )
        begun = self._begin(pending, believed[0] & believed[1])
        after: Belief = _either(prior.alive, gone, begun)
        inputs, known = self._inputs(pending, trust)
        return after._replace(inputs=inputs, known=known)

    @property
    def _polar(self) -> bool:
        return len(self.columns.velocity) == 1

    def _predict(self, belief: Belief, time: Float[Array, ""]) -> Belief:
        dt = time - belief.time
        good = belief.alive & (dt >= 0) & (dt <= GAP_S)
        dt = jnp.where(good, dt, 0.0)
        # (18) Ω(k|k-1) = f(Ω(k-1|k-1), U),  F = ∂f/∂Ω
        mean, f = self.ahead(belief.mean, belief.inputs, dt), jax.jacfwd(self.ahead)(belief.mean, belief.inputs, dt)
        moves = jnp.minimum((belief.mean[3] / LEAST_TURNING) ** 2, 1.0)  # a car at rest keeps its heading
        unknown = jnp.where(belief.known, 0.0, jnp.asarray(IGNORANCE) ** 2)
        heading, speed = (self.q[2] + unknown[1]) * moves, self.q[3] + unknown[0]
        q = jnp.concatenate([self.q[:2], jnp.stack([heading, speed]), self.q[4:]])
        # (19) P(k|k-1) = F P Fᵀ + Q
        return belief._replace(mean=mean, cov=carried(f, belief.cov) + jnp.diag(q * dt), time=time, alive=good)

    def ahead(self, mean: Float[Array, "6"], inputs: Float[Array, "2"], dt: Float[Array, ""]) -> Float[Array, "6"]:
        """The state `dt` later: (16), and biases that stay. With dt below zero, the state before."""
        v, turn = mean[3], inputs[1] - mean[4]
        if self.columns.steering:
            # κ = tan δ / l
            curvature = jnp.tan(jnp.clip(turn, -STEEPEST, STEEPEST)) / self.wheelbase
        else:
            # κ = yaw rate / v
            slow = jnp.abs(v) < LEAST_TURNING
            curvature = turn * jnp.where(slow, v / LEAST_TURNING**2, 1.0 / jnp.where(slow, 1.0, v))
        acceleration = inputs[0] - mean[5]
        # the midpoint rule: x and y by heading and speed halfway there
        half = bicycle(mean[:4], acceleration, curvature, dt / 2)
        way = bicycle(half, acceleration, curvature, dt)[:2] - half[:2]
        whole = bicycle(mean[:4], acceleration, curvature, dt)
        return jnp.concatenate([mean[:2] + way, whole[2:], mean[4:]])

    def measured(self, mean: Float[Array, "6"], inputs: Float[Array, "2"]) -> Float[Array, " M"]:
        """What should be measured: x, y [m] and speed, or velocity north and east, as they were `late_s` ago."""
        place, motion = (self.ahead(mean, inputs, -self.late_s[i]) for i in range(2))
        phi, v = motion[2], motion[3]
        v = v * self.speed_scale
        velocity = (v,) if len(self.columns.velocity) == 1 else (v * jnp.sin(phi), v * jnp.cos(phi))
        return jnp.stack([place[0], place[1], *velocity])

    def _residual(self, work: _Work, turned: Float[Array, "M M"], expected: Float[Array, " M"]) -> Residual:
        """The innovation in the channels' own units: radians of latitude and longitude for metres."""
        prior, sample, _, _, innovation, s, there, _ = work
        anchor = prior.anchor
        north, east = wrapped(moved(anchor[0], anchor[1], jnp.ones(2)) - anchor)  # [rad/m]
        where = moved(anchor[0], anchor[1], expected[:2])
        latitude, longitude = self.columns.position
        at = jnp.asarray((longitude, latitude, *self.columns.velocity))
        to = (jnp.arange(self.channels)[:, None] == at[None]).astype(float)  # x is longitude, y latitude
        mine = to.sum(axis=1) > 0
        scale = jnp.concatenate([jnp.stack([east, north]), jnp.ones(len(self.columns.velocity))])
        # back from along and across the heading
        units = ((to * scale[None])[:, :, None] * turned.T[None]).sum(axis=1)
        rest = jnp.where(mine, 0.0, 1.0)
        return Residual(
            time=sample.time,
            value=units @ innovation,
            cov=carried(units, s) + jnp.diag(rest),
            measured=sample.value,
            expected=jnp.where(
                mine & prior.alive, to @ jnp.concatenate([jnp.stack([where[1], where[0]]), expected[2:]]), sample.value
            ),
            noise=(units**2) @ self.r + rest,
            valid=to @ there.astype(float) > 0,
            born=sample.born,
            extra=innovation[:2],
        )

    def _inputs(self, pending: _Work, trust: Trust) -> tuple[Float[Array, "2"], Bool[Array, "2"]]:
        """U for the next prediction, and whether it is known: the newest that is believed, through the low pass."""
        prior, sample = pending.prior, pending.sample
        inputs, known = [], []
        keep = self.smooth_s / (self.smooth_s + jnp.clip(pending.dt, 1e-9, GAP_S))
        turn_at = self.columns.steering or self.columns.gyro
        for i, (at, axis) in enumerate(((self.columns.accelerometer, self.forward), (turn_at, self.turning))):
            if not at:
                inputs.append(jnp.zeros(()))
                known.append(jnp.zeros((), bool))
                continue
            good = picked(trust.measured, at).all()
            held = picked(sample.present, at).all() & ~picked(sample.fresh, at).any()
            now, last = axis @ picked(sample.value, at), prior.inputs[i]
            passed = jnp.where(prior.known[i], now + (last - now) * keep, now)
            inputs.append(jnp.where(good, passed, last))
            known.append(good | (held & prior.known[i]))
        return jnp.stack(inputs), jnp.stack(known)

    def _begin(self, pending: _Work, believed: Bool[Array, ""]) -> Belief:
        """A filter that waits for its first way, or has just gone it."""
        prior, sample, way = pending.prior, pending.sample, pending.way
        here = picked(sample.value, self.columns.position)
        fix = believed & on_the_map(here[0], here[1])
        age = sample.time - prior.fixed
        marked = (age > 0) & (age <= MARK_S)
        far = jnp.hypot(way[0], way[1])
        begins = fix & marked & (far >= START_M) & (far <= FASTEST * age)
        mark = fix & (begins | ~marked | (far > FASTEST * age))
        heading = jnp.arctan2(jnp.where(begins, way[1], 0.0), jnp.where(begins, way[0], 1.0))
        speed = jnp.where(begins, far / jnp.where(marked, age, 1.0), 0.0)
        return prior._replace(
            mean=jnp.concatenate([jnp.zeros(2), jnp.stack([heading, speed]), self.bias]),
            cov=jnp.diag(jnp.concatenate([jnp.asarray(START_SPREAD), self.bias_spread]) ** 2),
            anchor=jnp.where(mark, here, prior.anchor),
            fixed=jnp.where(mark, sample.time, prior.fixed),
            agreed=jnp.where(begins, sample.time, prior.agreed),
            alive=begins,
        )


def _turned(heading: Float[Array, ""], size: int) -> Float[Array, "M M"]:
    """East and north into along and across; the rest as it is."""
    c, s = jnp.cos(heading), jnp.sin(heading)
    corner = jnp.stack([jnp.stack([c, s]), jnp.stack([-s, c])])
    return jnp.block([[corner, jnp.zeros((2, size - 2))], [jnp.zeros((size - 2, 2)), jnp.eye(size - 2)]])


def _either(first: Bool[Array, ""], one: Belief, other: Belief) -> Belief:
    chosen: Belief = jax.tree.map(lambda a, b: jnp.where(first, a, b), one, other)
    return chosen
