"""Side force: what the accelerometer feels to the left, minus what a car that goes where it points would feel."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.vehicles.inertial import SideOn

SLOWEST = 15 / 3.6  # below this, a start in a bend or a kerb is as hard as a slide [m/s]


class Aside(NamedTuple):
    """Side force felt minus expected [m/s^2]; `ready`: whether there was anything to compare."""

    force: Float[Array, ""]
    ready: Bool[Array, ""]


class _State(NamedTuple):
    speed: Float[Array, ""]  # the last trusted one [m/s]
    received: Float[Array, ""]  # when that was [s]


class _Work(NamedTuple):
    state: _State
    time: Float[Array, ""]
    speed: Float[Array, ""]
    new: Bool[Array, ""]


class SideForce(eqx.Module):
    """e = a_left - k v ω: a bicycle does not slip, so it is pushed to the inside of a turn by speed times turn rate.

    The rate and the force come from one unit at one time, so what a receiver is late by does not matter; its speed
    changes slowly. Compared above SLOWEST. It answers for no channel: `extra` is an `Aside`. A speed stands for
    `stale_s`.
    """

    unit: SideOn
    gain: Float[Array, ""]  # k: near 1; a car that leans feels gravity too
    stale_s: Float[Array, ""]
    velocity: tuple[int, int] = eqx.field(static=True)
    polar: bool = eqx.field(static=True)
    channels: int = eqx.field(static=True)

    def init(self) -> _State:
        return _State(jnp.zeros(()), jnp.asarray(NEVER, float))

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        first, second = self.velocity
        result = sample.value[first], sample.value[second]
        speed = jnp.abs(result[0]) if self.polar else jnp.hypot(*result)
        new = sample.fresh[first] & (self.polar | sample.fresh[second])
        force, rate, there = self.unit.force_and_turn(sample)
        age = sample.time - state.received
        ready = there & (age >= 0) & (age <= self.stale_s) & (state.speed >= SLOWEST)
        # e = a_left - k v ω
        e = jnp.where(ready, force - self.gain * state.speed * rate, 0.0)
        nothing = jnp.zeros(self.channels)
        residual = Residual(
            time=sample.time,
            value=nothing,
            cov=jnp.eye(self.channels),
            measured=sample.value,
            expected=sample.value,
            noise=nothing + 1,
            valid=nothing > 0,
            born=sample.born,
            extra=Aside(e, ready),
        )
        return residual, _Work(state, sample.time, speed, new)

    def update(self, work: _Work, trust: Trust) -> _State:
        first, second = self.velocity
        taken = work.new & trust.measured[first] & (self.polar | trust.measured[second])
        return _State(jnp.where(taken, work.speed, work.state.speed), jnp.where(taken, work.time, work.state.received))
