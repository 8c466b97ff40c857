"""Displacement residual: a new position minus the one a second ago moved by a network's displacement."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.local import east_north, moved, wrapped
from sensorfault.numerics.networks.lstm import Lstm
from sensorfault.vehicles.bicycle import ground_velocity


class Seen(NamedTuple):
    """What the network saw (s, F), the way it was to mend, and the way that was measured, east and north [m]."""

    window: Float[Array, "s F"]
    base: Float[Array, "2"]
    way: Float[Array, "2"]


class _State(NamedTuple):
    rows: Float[Array, "N F"]  # of the samples before, scaled, the oldest first
    places: Float[Array, "N 3"]  # latitude, longitude [rad] and when they were measured [s], as held then
    since: Float[Array, ""]  # of rows since the position came (again)
    taken: Float[Array, ""]  # when it last came or was stood in for [s]
    time: Float[Array, ""]  # of the newest row [s]


class _Work(NamedTuple):
    state: _State
    row: Float[Array, " F"]
    now: Float[Array, ""]


class Displacement(eqx.Module):
    """y~ = p(i-n) + way, way = base + half net(window); the newest n samples of the position are not looked at.

    `base` is the mean velocity over these samples times their time or, where the log has no velocity, the way of the n
    samples before. The window holds the newest 2 n = N samples of gyro, accelerometer and velocity, averaged by
    `stride`, each with the way before beside it. n samples are about a second.

    Position is valid once N samples have followed on it. A gap in the clock of more than `gap_s`, or more than
    `stale_s` without a position to take, starts all anew.
    """

    network: Lstm
    center: Float[Array, " I"]  # middle of the training range of the inertial channels [SI]
    half: Float[Array, " I"]  # half of it [SI]
    fastest: Float[Array, ""]  # of the training data [m/s]
    mend: Float[Array, ""]  # unit of the network's answer [m]
    cov: Float[Array, "C C"]  # of the residual on healthy data [SI]
    gap_s: Float[Array, ""]
    stale_s: Float[Array, ""]
    size: int = eqx.field(static=True)  # n
    stride: int = eqx.field(static=True)
    position: tuple[int, int] = eqx.field(static=True)
    inertial: tuple[int, ...] = eqx.field(static=True)
    velocity: tuple[int, ...] = eqx.field(static=True)  # two columns, or none
    polar: bool = eqx.field(static=True)

    def init(self) -> _State:
        never = jnp.full((), NEVER, float)
        width = len(self.inertial) + len(self.velocity)
        return _State(jnp.zeros((2 * self.size, width)), jnp.zeros((2 * self.size, 3)), jnp.zeros(()), never, never)

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        n, now = self.size, sample.time
        gone = (now - state.time > self.gap_s) | (now - state.taken > self.stale_s)
        state = state._replace(since=jnp.where(gone, 0.0, state.since))
        row = self._row(sample.value)
        rows = jnp.concatenate([state.rows[1:], row[None]])
        origin, earlier = state.places[n], state.places[0]
        elapsed = now - origin[2]
        before = east_north(origin[0], origin[1], earlier[0], earlier[1])
        if self.velocity:
            base = rows[n:, -2:].mean(axis=0) * self.fastest * elapsed
        else:
            base = before * elapsed / jnp.maximum(origin[2] - earlier[2], 0.1)
        steps = rows.reshape(-1, self.stride, rows.shape[1]).mean(axis=1)
        window = jnp.concatenate([steps, jnp.broadcast_to(before / self.fastest, (steps.shape[0], 2))], axis=1)
        latitude, longitude = (sample.value[c] for c in self.position)
        place = moved(origin[0], origin[1], base + self.mend * self.network(window))
        left = jnp.stack([latitude - place[0], wrapped(longitude - place[1])])
        warm = sample.fresh & (state.since >= 2 * n)
        nothing = jnp.zeros_like(sample.value)
        residual = Residual(
            time=now,
            value=self._placed(left, nothing),
            cov=self.cov,
            measured=sample.value,
            expected=self._placed(place, sample.value),
            noise=(jnp.eye(nothing.size) * self.cov).sum(axis=1),
            valid=self._placed(jnp.stack([warm[c] for c in self.position]), nothing > 0),
            born=sample.born,
            extra=Seen(window, base, east_north(latitude, longitude, origin[0], origin[1])),
        )
        return residual, _Work(state, row, now)

    def update(self, pending: _Work, trust: Trust) -> _State:
        state, row, now = pending
        taken = jnp.stack([(trust.measured | trust.filled)[c] for c in self.position]).all()
        place = jnp.stack([*(trust.value[c] for c in self.position), now])
        places = jnp.concatenate([state.places[1:], jnp.where(taken, place, state.places[-1])[None]])
        came = jnp.where(taken, now, state.taken)
        count = jnp.where(now - came > self.stale_s, 0.0, jnp.minimum(state.since + 1, 2.0 * self.size))
        return _State(jnp.concatenate([state.rows[1:], row[None]]), places, count, came, now)

    def _row(self, value: Float[Array, " C"]) -> Float[Array, " F"]:
        """Gyro and accelerometer on [-1, 1], velocity in units of the fastest."""
        parts = [jnp.zeros(0)]
        if self.inertial:
            parts.append((jnp.stack([value[c] for c in self.inertial]) - self.center) / self.half)
        if self.velocity:
            first, second = self.velocity
            parts.append(ground_velocity(value[first], value[second], self.polar) / self.fastest)
        return jnp.concatenate(parts)

    def _placed(self, of_position: Array, of_others: Array) -> Array:
        """One number a channel: those of latitude and longitude in their places."""
        at = self.position
        return jnp.stack([of_position[at.index(c)] if c in at else of_others[c] for c in range(of_others.size)])
