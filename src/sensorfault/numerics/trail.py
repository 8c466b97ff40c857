"""A trail of positions with the distance travelled since each: K slots, the newest first, masks instead of indices."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

NEAR_S = 1e-6  # ages closer than this are the same


class Trail(NamedTuple):
    """Positions (latitude, longitude [rad]) with age [s], displacement east and north [m] and path length since [m].

    `velocity`: east and north [m/s] when the place was put down. `there`: whether the slot holds a place.
    """

    latitude: Float[Array, " K"]
    longitude: Float[Array, " K"]
    velocity: Float[Array, "K 2"]
    age: Float[Array, " K"]
    way: Float[Array, "K 2"]
    path: Float[Array, " K"]
    there: Bool[Array, " K"]

    @classmethod
    def empty(cls, slots: int) -> "Trail":
        """No position yet."""
        flat, pairs = jnp.zeros(slots), jnp.zeros((slots, 2))
        return cls(flat, flat, pairs, flat, pairs, flat, jnp.zeros(slots, bool))

    def carried(self, dt: Float[Array, ""], step: Float[Array, "2"], length: Float[Array, ""]) -> "Trail":
        """After another `dt` [s] in which the vehicle went `step` (east, north) along a path of `length` [m]."""
        return self._replace(age=self.age + dt, way=self.way + step[None], path=self.path + length)

    def kept(self, still: Bool[Array, ""]) -> "Trail":
        """The same trail, or no place at all. What is not there stays at zero, so that nothing grows for ever."""
        there = self.there & still
        fields = [jnp.where(there if x.ndim == 1 else there[:, None], x, 0.0) for x in self[:-1]]
        return Trail(*[*fields, there])

    def put(
        self,
        now: Bool[Array, ""],
        latitude: Float[Array, ""],
        longitude: Float[Array, ""],
        velocity: Float[Array, "2"],
        spacing: Float[Array, ""],
    ) -> "Trail":
        """Add a new position in front, if `now` and the newest is at least `spacing` [s] old; drop the oldest."""
        zero = jnp.zeros(())
        place = Trail(latitude, longitude, velocity, zero, jnp.zeros(2), zero, jnp.ones((), bool))
        push = now & ((self.age[0] >= spacing - NEAR_S) | ~self.there[0])

        def shifted(slots: Array, new: Array) -> Array:
            return jnp.where(push, jnp.concatenate([new[None], slots[:-1]]), slots)

        return Trail(*jax.tree.map(shifted, tuple(self), tuple(place)))

    def newest(self, least: Float[Array, ""]) -> Bool[Array, " K"]:
        """Mask of the newest position that is at least so old [s]; all False if there is none."""
        fit = self.there & (self.age >= least - NEAR_S)
        # the first that fits: none before it does
        before = jnp.cumsum(fit.astype(self.age.dtype)) - fit.astype(self.age.dtype)
        return fit & (before < 0.5)

    def pick(self, one: Bool[Array, " K"]) -> "Trail":
        """The position of this mask: its fields without the leading axis, zeros if the mask is empty."""
        fields = [jnp.where(one if x.ndim == 1 else one[:, None], x, 0.0).sum(axis=0) for x in self[:-1]]
        return Trail(*[*fields, one.any()])
