"""Motion deficit: integrated velocity minus the displacement of the position."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.numerics.local import east_north, moved, on_the_map, wrapped
from sensorfault.numerics.trail import Trail
from sensorfault.vehicles.bicycle import ground_velocity
from sensorfault.vehicles.inertial import STANDING, Inertial, turned

HOLD_S = 1.0  # for so long a velocity stands for the next
GROWTH = 3.0  # what a velocity may change a second meanwhile [m/s^2]


class Deficits(NamedTuple):
    """What the statistics of this residual need. H horizons.

    `deficit`: way minus displacement since the reference, east and north [m], `sigma` its healthy size [m]; `age`,
    `path` and `swing` since then: time [s], way along the path [m], change of the velocity [m/s]. `ready`: there is a
    reference and a new fix. `length`: way along the path since the last sample [m], 0 if not `known`.
    """

    deficit: Float[Array, "H 2"]
    sigma: Float[Array, " H"]
    age: Float[Array, " H"]
    path: Float[Array, " H"]
    swing: Float[Array, " H"]
    ready: Bool[Array, " H"]
    fix: Bool[Array, ""]
    length: Float[Array, ""]
    known: Bool[Array, ""]


class _State(NamedTuple):
    time: Float[Array, ""]
    result: Float[Array, "2"]  # the last trusted velocity, east and north [m/s]
    received: Float[Array, ""]  # when it came [s]
    ground: Float[Array, "2"]  # the velocity now, without the receiver's lag [m/s]
    ahead: Float[Array, "2"]  # what the receiver's lag has not shown yet: turn [rad], speed [m/s]
    stuck: Float[Array, ""]  # for how long a velocity has repeated itself to the last bit [s]
    trail: Trail


class _Work(NamedTuple):
    """The state carried on by the velocity before, and the correction by this sample's own if it is trusted."""

    state: _State
    new: Bool[Array, ""]  # there is a new velocity
    result: Float[Array, "2"]
    now: Float[Array, "2"]  # without the lag
    mended: Float[Array, "2"]  # [m]
    longer: Float[Array, ""]  # [m]
    place: Float[Array, "2"]
    fix: Bool[Array, ""]
    ahead: tuple[Float[Array, "2"], Float[Array, "2"]]  # with this sample's word of the inertial unit, and without
    fresh: Bool[Array, " C"]
    repeated: Bool[Array, ""]  # the velocity is to the last bit what it was


class MotionDeficit(eqx.Module):
    """Distance by speed and heading minus the displacement of the position, over H horizons (1 s).

    Min et al. 2021 look for jammed positions with a network (section 2.2); a frozen position misses all of it.
    Speed and course are freed of the receiver's lag by the inertial unit, where there is one, and held for a second.
    Only trusted fixes become references, so under a long fault the reference grows old and `law` allows more: the
    variance is law . (1, swing^2, path^2, age^2). After `afresh_s` without a trusted fix it begins anew, and so it does
    when a velocity moves on that was stuck for longer than HOLD_S: nobody knows where the car has been meanwhile.
    """

    law: Float[Array, "H 4"]  # [m^2], [s^2], [1], [m^2/s^2]
    horizon_s: Float[Array, " H"]
    spacing_s: Float[Array, ""]  # between two references
    afresh_s: Float[Array, ""]
    inertial: Inertial | None
    position: tuple[int, int] = eqx.field(static=True)
    velocity: tuple[int, int] = eqx.field(static=True)
    polar: bool = eqx.field(static=True)
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True, default=8)

    def init(self) -> _State:
        never = jnp.asarray(NEVER, float)
        return _State(never, jnp.zeros(2), never, jnp.zeros(2), jnp.zeros(2), jnp.zeros(()), Trail.empty(self.slots))

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        first, second = self.velocity
        place = jnp.stack([sample.value[i] for i in self.position])
        fix = jnp.stack([sample.fresh[i] for i in self.position]).all() & on_the_map(place[0], place[1])
        new = sample.fresh[first] & sample.fresh[second]
        result = ground_velocity(sample.value[first], sample.value[second], self.polar)
        dt = jnp.clip(sample.time - state.time, 0.0, HOLD_S)

        silence = sample.time - state.received
        lasting = (silence >= 0) & (silence <= HOLD_S)  # else the way since any place is lost
        since = jnp.clip(silence, 0.0, HOLD_S)
        # by the lag's measure of the sample before, which has been judged
        held, now = (turned(velocity, state.ahead[0], state.ahead[1]) for velocity in (state.result, result))
        step = (state.ground + held) / 2 * dt
        trail = state.trail.kept(lasting).carried(dt, step, jnp.linalg.norm(step))
        trail = trail.kept(trail.age[0] <= self.afresh_s)
        # what was summed up by the velocity before is mended by half of what has changed: the trapezoid
        mended = (now - held) / 2 * since
        longer = (jnp.linalg.norm(now) - jnp.linalg.norm(held)) / 2 * since
        carried = state._replace(time=sample.time, ground=held, trail=trail)
        ahead = self._ahead(state.ahead, sample, dt)
        repeated = (result == state.result).all() & (jnp.linalg.norm(result) > STANDING)
        work = _Work(carried, new, result, now, mended, longer, place, fix, ahead, sample.fresh, repeated)

        here = _mended(work, new)
        length = jnp.where(lasting, jnp.maximum(jnp.linalg.norm(step) + jnp.where(new, longer, 0.0), 0.0), 0.0)
        over = self._deficits(here, place, fix, jnp.where(new, 0.0, since))
        deficits = Deficits(*[*over, fix, length, lasting])
        return self._residual(sample, here.trail, deficits), work

    def update(self, work: _Work, trust: Trust) -> _State:
        believed = jnp.stack([trust.measured[i] for i in self.velocity]).all() & work.new
        state = _mended(work, believed)
        silence = state.time - state.received
        known = (silence >= 0) & (silence <= HOLD_S)
        trusted = jnp.stack([trust.measured[i] for i in self.position]).all() & work.fix & known
        trail = state.trail.put(trusted, work.place[0], work.place[1], state.ground, self.spacing_s)
        with_unit, without = work.ahead
        if self.inertial is not None:
            without = jnp.where(self.inertial.trusted(trust, work.fresh), with_unit, without)
        return state._replace(trail=trail, ahead=without)

    def _ahead(
        self, ahead: Float[Array, "2"], sample: Sample, dt: Float[Array, ""]
    ) -> tuple[Float[Array, "2"], Float[Array, "2"]]:
        """What a first-order lag keeps back: the integral of the rates, forgotten at the lag's own pace."""
        if self.inertial is None:
            return ahead, ahead
        rates, _ = self.inertial.rates(sample)
        left = self.inertial.decay(dt)
        return (ahead + rates * dt) * left, ahead * left

    def _deficits(
        self, here: _State, place: Float[Array, "2"], fix: Bool[Array, ""], held_s: Float[Array, ""]
    ) -> tuple[Array, ...]:
        """The fields of Deficits from `deficit` to `ready`, stacked over the horizons."""

        def over(horizon_s: Array, law: Array) -> tuple[Array, ...]:
            since = here.trail.pick(here.trail.newest(horizon_s))
            gone = east_north(place[0], place[1], since.latitude, since.longitude)
            swing = jnp.linalg.norm(here.ground - since.velocity)
            # sigma^2 = c0 + c1 swing^2 + c2 path^2 + c3 age^2, and what a held velocity may have missed
            terms = jnp.stack([jnp.ones(()), swing**2, since.path**2, since.age**2])
            variance = (law * terms).sum() + (GROWTH * held_s**2 / 2) ** 2
            return since.way - gone, jnp.sqrt(variance), since.age, since.path, swing, since.there & fix

        result: tuple[Array, ...] = jax.vmap(over)(self.horizon_s, self.law)
        return result

    def _residual(self, sample: Sample, trail: Trail, deficits: Deficits) -> Residual:
        """In the units of the channels: measured position minus that of the reference carried on [rad]."""
        since = trail.pick(trail.newest(self.horizon_s[0]))
        latitude, longitude = moved(since.latitude, since.longitude, since.way)
        value = jnp.zeros(self.channels)
        expected, noise = sample.value, jnp.ones(self.channels)
        valid = jnp.zeros(self.channels, bool)
        # a metre north and east as angles, roughly
        metre = jnp.stack([jnp.ones(()), 1 / jnp.maximum(jnp.cos(since.latitude), 1e-3)]) / SEMI_MAJOR_AXIS
        for i, there, one in zip(self.position, (latitude, longitude), metre, strict=True):
            mine = (jnp.arange(self.channels) == i) & since.there
            off = wrapped(sample.value[i] - there)
            value = jnp.where(mine, off, value)
            expected = jnp.where(mine, there, expected)
            noise = jnp.where(mine, (one * deficits.sigma[0]) ** 2, noise)
            valid = valid | (mine & deficits.ready[0])
        cov = jnp.eye(self.channels) * noise[None]
        return Residual(sample.time, value, cov, sample.value, expected, noise, valid, sample.born, extra=deficits)


def _mended(work: _Work, by: Bool[Array, ""]) -> _State:
    """The state with this sample's velocity taken in, or without it."""
    state, trail = work.state, work.state.trail
    since = jnp.clip(state.time - state.received, 0.0, HOLD_S)
    baarda_w = by & ~work.repeated & (state.stuck > HOLD_S)
    trail = trail.kept(~baarda_w)
    way = trail.way + jnp.where(by & trail.there[:, None], work.mended[None], 0.0)
    path = trail.path + jnp.where(by & trail.there, work.longer, 0.0)
    return state._replace(
        result=jnp.where(by, work.result, state.result),
        received=jnp.where(by, state.time, state.received),
        ground=jnp.where(by, work.now, state.ground),
        stuck=jnp.where(by, jnp.where(work.repeated, state.stuck + since, 0.0), state.stuck),
        trail=trail._replace(way=way, path=path),
    )
