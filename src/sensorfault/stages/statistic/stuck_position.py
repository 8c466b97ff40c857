"""Way gone since the position last changed: an exact repeat that the velocity contradicts."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Score, Trust


class _Stood(NamedTuple):
    place: Float[Array, "2"]
    known: Bool[Array, ""]
    path: Float[Array, ""]  # [m]


class StuckPosition(eqx.Module):
    """Way along the path [m] over which new fixes have repeated one position to the last bit.

    A parked car repeats itself as long as it likes; a moving one does so for no longer than its receiver's resolution.
    """

    accused: Bool[Array, " C"]
    position: tuple[int, int] = eqx.field(static=True)

    def init(self) -> _Stood:
        return _Stood(jnp.zeros(2), jnp.zeros((), bool), jnp.zeros(()))

    def evaluate(self, state: _Stood, residual: Residual) -> tuple[Score, _Stood]:
        result = residual.extra
        place = jnp.stack([residual.measured[i] for i in self.position])
        path = jnp.where(result.known, state.path + result.length, 0.0)
        same = state.known & (place == state.place).all()
        there = result.fix & ~(self.accused & jnp.asarray(residual.out)).any()
        covers = self.accused[None]
        score = Score(jnp.where(same, path, 0.0)[None], there[None], covers, covers.astype(path.dtype))
        after = _Stood(
            jnp.where(result.fix, place, state.place),
            state.known | result.fix,
            jnp.where(result.fix & ~same, 0.0, path),
        )
        return score, after

    def update(self, pending: _Stood, trust: Trust) -> _Stood:
        return pending
