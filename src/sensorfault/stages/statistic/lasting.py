"""The side force that a car should not feel, through a low pass that removes bumps of the road."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Score, Trust

WARM = 4.0  # time constants after a gap until the low pass has forgotten how it began


class _Lately(NamedTuple):
    force: Float[Array, ""]
    time: Float[Array, ""]
    since: Float[Array, ""]  # when it began (anew) [s]


class Lasting(eqx.Module):
    """|low pass of e| [m/s^2], e of residual/side_force.py. A gap of more than one time constant begins it anew."""

    constant_s: Float[Array, ""]
    examined: Bool[Array, " C"]

    def init(self) -> _Lately:
        never = jnp.asarray(NEVER, float)
        return _Lately(jnp.zeros(()), never, never)

    def evaluate(self, state: _Lately, residual: Residual) -> tuple[Score, _Lately]:
        e, ready = residual.extra
        dt = residual.time - state.time
        anew = (dt > self.constant_s) | (dt <= 0)
        # y <- y + (1 - exp(-dt / T)) (e - y)
        gain = jnp.where(anew, 1.0, 1 - jnp.exp(-jnp.clip(dt, 0.0, self.constant_s) / self.constant_s))
        force = state.force + gain * (e - state.force)
        since = jnp.where(anew, residual.time, state.since)
        after = _Lately(
            jnp.where(ready, force, state.force),
            jnp.where(ready, residual.time, state.time),
            jnp.where(ready, since, state.since),
        )
        warm = ready & (residual.time - since >= WARM * self.constant_s)
        covers = self.examined[None]
        return Score(jnp.abs(force)[None], warm[None], covers, covers.astype(force.dtype)), after

    def update(self, pending: _Lately, trust: Trust) -> _Lately:
        return pending
