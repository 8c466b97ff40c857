"""How much way is missing between raw fixes: the mark of a position that stands still while the car moves."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Score, Trust
from sensorfault.numerics.local import east_north
from sensorfault.numerics.trail import Trail


class _Raw(NamedTuple):
    time: Float[Array, ""]
    trail: Trail


class Shortfall(eqx.Module):
    """Way along the path minus `times` the displacement over the last `horizon_s` [m], if positive.

    For residual/motion_deficit.py.

    With times = 2: by how much more than half of the way is missing. Judged between fixes as they came, trusted or not
    (evidence, not reference), so a frozen position is seen for as long as it lasts, and no longer. It needs no heading.
    """

    horizon_s: Float[Array, ""]
    times: Float[Array, ""]
    accused: Bool[Array, " C"]
    position: tuple[int, int] = eqx.field(static=True)
    slots: int = eqx.field(static=True, default=8)

    def init(self) -> _Raw:
        return _Raw(jnp.asarray(NEVER, float), Trail.empty(self.slots))

    def evaluate(self, state: _Raw, residual: Residual) -> tuple[Score, _Raw]:
        result = residual.extra
        dt = jnp.clip(residual.time - state.time, 0.0, 2 * self.horizon_s)
        trail = state.trail.kept(result.known).carried(dt, jnp.zeros(2), result.length)
        since = trail.pick(trail.newest(self.horizon_s))
        latitude, longitude = (residual.measured[i] for i in self.position)
        gone = jnp.linalg.norm(east_north(latitude, longitude, since.latitude, since.longitude))
        covers = self.accused[None]
        there = result.fix & since.there & ~(self.accused & jnp.asarray(residual.out)).any()
        # times = 2: by how much more than half of the way is missing
        missing = jnp.maximum(since.path - self.times * gone, 0.0)
        score = Score(missing[None], there[None], covers, covers.astype(gone.dtype))
        spacing = self.horizon_s / (self.slots - 2)
        return score, _Raw(residual.time, trail.put(result.fix, latitude, longitude, jnp.zeros(2), spacing))

    def update(self, pending: _Raw, trust: Trust) -> _Raw:
        return pending
