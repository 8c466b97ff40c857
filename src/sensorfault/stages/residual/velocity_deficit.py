"""Velocity deficit: the velocity over ground against what the inertial unit has made of it since."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.local import wrapped
from sensorfault.vehicles.bicycle import ground_velocity
from sensorfault.vehicles.inertial import STANDING, Inertial, turned

SLOWEST = 3.0  # below this the inertial unit is led, not compared [m/s]
HOLD_S = 1.0  # after so long without a velocity it begins anew


class Slip(NamedTuple):
    """Velocity said minus velocity by the inertial unit: along and across the latter [m/s]; `ready`: comparable."""

    slip: Float[Array, "2"]
    ready: Bool[Array, ""]


class _State(NamedTuple):
    time: Float[Array, ""]
    received: Float[Array, ""]  # the last new velocity [s]
    believed: Float[Array, ""]  # the last trusted one [s]
    result: Float[Array, "2"]  # ... and what it was, east and north [m/s]
    stuck: Float[Array, ""]  # for how long it has repeated itself to the last bit [s]
    slow: Float[Array, ""]  # when the unit was last led [s]
    rates: Float[Array, "2"]  # as late as the receiver is
    velocity: Float[Array, "2"]  # by the inertial unit, east and north [m/s]


class _Work(NamedTuple):
    state: _State  # carried on to now
    result: Float[Array, "2"]
    new: Bool[Array, ""]
    rates: Float[Array, "2"]  # with this sample's word of the inertial unit
    fresh: Bool[Array, " C"]
    repeated: Bool[Array, ""]  # the velocity is to the last bit what it was
    baarda_w: Bool[Array, ""]  # ... and was so for long, and is no more


class VelocityDeficit(eqx.Module):
    """A complementary filter: the inertial unit turns and pushes the velocity, which is forgotten within `memory_s`.

    So slopes and biases, which last, are forgotten, and a receiver that freezes as a whole is seen as far as the car
    turns or changes its speed within that time. Only trusted velocities correct it; `afresh_s` after the last of them
    it begins anew, and so it does when a velocity moves on that was stuck for longer than HOLD_S and corrected it
    meanwhile. Below SLOWEST, and while the inertial unit itself is distrusted, it follows the receiver and nothing is
    compared.
    """

    memory_s: Float[Array, ""]
    afresh_s: Float[Array, ""]
    variance: Float[Array, "2"]  # of the slip on healthy data, along and across [m^2/s^2]
    inertial: Inertial
    velocity: tuple[int, int] = eqx.field(static=True)
    polar: bool = eqx.field(static=True)
    channels: int = eqx.field(static=True)

    def init(self) -> _State:
        never = jnp.asarray(NEVER, float)
        return _State(never, never, never, jnp.zeros(2), jnp.zeros(()), never, jnp.zeros(2), jnp.zeros(2))

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        first, second = self.velocity
        new = sample.fresh[first] & sample.fresh[second]
        result = ground_velocity(sample.value[first], sample.value[second], self.polar)
        dt = jnp.clip(sample.time - state.time, 0.0, HOLD_S)
        rates, there = self.inertial.rates(sample)
        lagging = rates + (state.rates - rates) * self.inertial.decay(dt)
        # by the rates of the sample before, which have been judged
        by_unit = turned(state.velocity, state.rates[0] * dt, state.rates[1] * dt)
        broken = ~there | (sample.time - state.received > HOLD_S) | (sample.time < state.time)
        slow = jnp.where(broken, sample.time, state.slow)

        speed = jnp.linalg.norm(by_unit)
        east, north = by_unit / jnp.maximum(speed, 0.1)
        off = result - by_unit
        slip = jnp.stack([off[0] * east + off[1] * north, off[0] * north - off[1] * east])
        repeated = (result == state.result).all() & (jnp.linalg.norm(result) > STANDING)
        baarda_w = new & ~repeated & (state.stuck > HOLD_S)
        ready = new & ~broken & ~baarda_w & (sample.time - slow >= self.memory_s / 4) & (speed >= SLOWEST)
        received = jnp.where(new, sample.time, state.received)
        carried = state._replace(time=sample.time, received=received, slow=slow, velocity=by_unit)
        work = _Work(carried, result, new, lagging, sample.fresh, repeated, baarda_w)
        return self._residual(sample, by_unit, Slip(jnp.where(ready, slip, 0.0), ready)), work

    def update(self, work: _Work, trust: Trust) -> _State:
        state, result = work.state, work.result
        believed = work.new & jnp.stack([trust.measured[i] for i in self.velocity]).all()
        since = state.time - state.believed
        lost = work.new & (since > self.afresh_s)
        unit = self.inertial.trusted(trust, work.fresh)
        led = lost | (believed & (work.baarda_w | ~unit | (jnp.linalg.norm(result) < SLOWEST)))
        # v <- v + (1 - exp(-dt / T)) (measured - v)
        gain = jnp.where(led, 1.0, jnp.where(believed, 1 - jnp.exp(-jnp.clip(since, 0.0, HOLD_S) / self.memory_s), 0.0))
        return state._replace(
            rates=jnp.where(unit, work.rates, state.rates),
            velocity=state.velocity + gain * (result - state.velocity),
            believed=jnp.where(believed | lost, state.time, state.believed),
            result=jnp.where(believed, result, state.result),
            stuck=jnp.where(
                believed, jnp.where(work.repeated, state.stuck + jnp.clip(since, 0.0, HOLD_S), 0.0), state.stuck
            ),
            slow=jnp.where(led | ~unit, state.time, state.slow),
        )

    def _residual(self, sample: Sample, by_unit: Float[Array, "2"], slip: Slip) -> Residual:
        east, north = by_unit
        speed = jnp.linalg.norm(by_unit)
        course = jnp.arctan2(east, north)
        said = (speed, jnp.mod(course, 2 * jnp.pi)) if self.polar else (north, east)
        along, across = self.variance
        spread = (along, across / jnp.maximum(speed, SLOWEST) ** 2) if self.polar else (along + across, along + across)
        value, expected, noise = jnp.zeros(self.channels), sample.value, jnp.ones(self.channels)
        valid = jnp.zeros(self.channels, bool)
        for k, i in enumerate(self.velocity):
            mine = jnp.arange(self.channels) == i
            off = sample.value[i] - said[k]
            value = jnp.where(mine, wrapped(off) if self.polar and k == 1 else off, value)
            expected = jnp.where(mine, said[k], expected)
            noise = jnp.where(mine, spread[k], noise)
            valid = valid | (mine & slip.ready)
        cov = jnp.eye(self.channels) * noise[None]
        return Residual(sample.time, value, cov, sample.value, expected, noise, valid, sample.born, extra=slip)
