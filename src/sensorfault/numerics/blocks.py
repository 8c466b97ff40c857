"""A window of blocks for each of C channels: K slots, the newest last; values close in time share a slot."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from math import ceil
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

EARLY = 0.1  # share of a beat by which a value may come early and still end it, because of jitter


class Blocks(NamedTuple):
    """For each slot the number of values, sum of weights, weighted mean, mean time and Σ weight value².

    `start`: when the newest slot began [s]. An empty slot is all zeros.
    """

    n: Float[Array, "K C"]
    weight: Float[Array, "K C"]
    value: Float[Array, "K C"]
    time: Float[Array, "K C"]  # [s]
    square: Float[Array, "K C"]
    start: Float[Array, " C"]  # [s]

    @classmethod
    def empty(cls, slots: int, channels: int) -> "Blocks":
        """No value yet."""
        nothing = jnp.zeros((slots, channels))
        return cls(nothing, nothing, nothing, nothing, nothing, jnp.zeros(channels))

    @property
    def newest(self) -> Float[Array, " C"]:
        """Mean time of the newest values [s], 0 where there is none."""
        return self.time[-1]

    def kept(self, still: Bool[Array, " C"]) -> "Blocks":
        """The same window or an empty one, for each channel."""
        return Blocks(*(jnp.where(still if x.ndim == 1 else still[None], x, 0.0) for x in self))

    def put(
        self,
        new: Bool[Array, " C"],
        value: Float[Array, " C"],
        weight: Float[Array, " C"],
        time: Float[Array, ""],
        spacing: Float[Array, ""],
    ) -> "Blocks":
        """Add a value where `new`: to a new slot if the newest is at least `spacing` old [s], else to the newest."""
        begins = (self.n[-1] == 0) | (time - self.start >= (1 - EARLY) * spacing)
        shift = new & begins & (self.n[-1] > 0)
        rows = [jnp.where(shift[None], jnp.concatenate([x[1:], jnp.zeros_like(x[:1])]), x) for x in self[:5]]
        n, w, y, t, q = (x[-1] for x in rows)
        more = w + weight
        joined = (
            n + 1,
            more,
            y + (value - y) * weight / jnp.where(more > 0, more, 1.0),
            jnp.where(n > 0, t + (time - t) / (n + 1), time),
            q + weight * value**2,
        )
        after = [jnp.concatenate([x[:-1], jnp.where(new, j, x[-1])[None]]) for x, j in zip(rows, joined, strict=True)]
        after.append(jnp.where(new & begins, time, self.start))
        return Blocks(*(x for x in after))


class Window(NamedTuple):
    """The last `length` seconds as a test uses them: slots with weights (0: empty or too old) and ages.

    `age` counts from the newest slot [s]. `many`: the values. `square`: Σ weight value², over the window.
    """

    age: Float[Array, "K C"]
    value: Float[Array, "K C"]
    weight: Float[Array, "K C"]
    many: Float[Array, " C"]
    square: Float[Array, " C"]
    length: Float[Array, ""]


def window(blocks: Blocks, length: Float[Array, ""]) -> Window:
    """The slots that are not older than `length` [s] before the newest."""
    age = jnp.where(blocks.n > 0, blocks.time[-1][None] - blocks.time, 0.0)
    there = (blocks.n > 0) & (age <= length)
    return Window(
        age=jnp.where(there, age, 0.0),
        value=jnp.where(there, blocks.value, 0.0),
        weight=jnp.where(there, blocks.weight, 0.0),
        many=jnp.where(there, blocks.n, 0.0).sum(axis=0),
        square=jnp.where(there, blocks.square, 0.0).sum(axis=0),
        length=length,
    )


def enough(length_s: float, spacing_s: float) -> int:
    """Slots for a window of this length, one for each value that comes after a spacing or a little earlier."""
    return ceil((length_s / spacing_s + 2) / (1 - EARLY))


def spacing(length: Float[Array, ""], slots: int) -> Float[Array, ""]:
    """Spacing of slot starts [s] such that so many slots cover a window of this length."""
    return length / ((1 - EARLY) * slots - 2)
