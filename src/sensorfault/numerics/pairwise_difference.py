"""Differences of pairs that should agree: their means some seconds ago and a minute ago, beat by beat."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.columns import shifted

RECENT, PAST, OLDEST = 10, 50, 10  # beats: the newest, those remembered before, and of these the reference's
NEWEST, ENOUGH = 2, 4  # beats that show a jump; so many trusted beats in RECENT are needed before it
FARTHEST = 1e9  # [m]
LEAST_S = 1e-6  # duration of a suspicion that has just begun [s]


class Memory(NamedTuple):
    """Of P pairs: the beat that is going on, the means of those before, and the references in use.

    `kept` and `sure`: the mean difference some seconds ago, and a minute ago, and whether it is known. While a pair is
    doubted both stay as they are, and the latter takes the place of what would be remembered.
    """

    began: Float[Array, ""]  # this beat [s]
    total: Float[Array, " P"]  # of the differences in this beat [m]
    many: Float[Array, " P"]
    recent: Float[Array, "R P"]  # the newest beats' means, the newest last [m]
    lived: Bool[Array, "R P"]  # whether there was one
    clean: Bool[Array, "R P"]  # whether it was trusted
    past: Float[Array, "Q P"]  # trusted means before them [m]
    trusted: Bool[Array, "Q P"]
    kept: Float[Array, "2 P"]  # [m]
    sure: Bool[Array, "2 P"]
    doubted: Float[Array, " P"]  # for how long [s]

    @classmethod
    def empty(cls, pairs: int, began: Float[Array, ""]) -> "Memory":
        """Nothing is known yet."""
        none, recent, past = jnp.zeros(pairs), jnp.zeros((RECENT, pairs)), jnp.zeros((PAST, pairs))
        no, two = recent > 0, jnp.zeros((2, pairs))
        return cls(began, none, none, recent, no, no, past, past > 0, two, two > 0, none)

    def received(self, both: Bool[Array, " P"], difference: Float[Array, " P"]) -> "Memory":
        """Add these differences to the beat."""
        return self._replace(
            total=jnp.where(both, self.total + difference, self.total), many=jnp.where(both, self.many + 1, self.many)
        )

    def beaten(self, over: Bool[Array, ""], now: Float[Array, ""]) -> "Memory":
        """If the beat is over, store it and begin the next."""
        return Memory(*[jnp.where(over, a, b) for a, b in zip(self._next(now), self, strict=True)])

    def _next(self, now: Float[Array, ""]) -> "Memory":
        lives, held = self.many > 0, self.doubted > 0
        # for a suspected beat the reference is stored instead
        clean, doubtful = self.clean[0], self.lived[0] & ~self.clean[0]
        after = self._replace(
            began=now,
            total=jnp.zeros_like(self.total),
            many=jnp.zeros_like(self.many),
            recent=shifted(self.recent, self.total / jnp.maximum(self.many, 1)),
            lived=shifted(self.lived, lives),
            clean=shifted(self.clean, lives & ~held),
            past=shifted(self.past, jnp.where(clean, self.recent[0], self.kept[1])),
            trusted=shifted(self.trusted, clean | (doubtful & self.sure[1])),
            doubted=jnp.where(held, self.doubted + (now - self.began), 0.0),
        )
        before, these = _mean(after.recent[:-NEWEST], after.clean[:-NEWEST])
        oldest, those = _mean(after.past[:OLDEST], after.trusted[:OLDEST])
        anew = jnp.stack([these >= ENOUGH, those >= OLDEST / 2]) & ~held[None]
        kept = jnp.where(anew, jnp.stack([before, oldest]), self.kept)
        return after._replace(kept=kept, sure=self.sure | anew)

    def gaps(self) -> tuple[Float[Array, "2 P"], Bool[Array, "2 P"]]:
        """How far the newest two beats are from the beats before them, and the newest ten from those of a minute ago
        [m]; and whether that is known.
        """
        gaps, known = [], []
        for length, kept, sure in zip((NEWEST, RECENT), self.kept, self.sure, strict=True):
            newest, many = _mean(self.recent[-length:], self.lived[-length:])
            gaps.append(newest - kept)
            known.append(sure & (many >= length / 2))
        return jnp.stack(gaps), jnp.stack(known)

    def since(self) -> Float[Array, " P"]:
        """Distance of the newest two beats from those of a minute ago [m]; FARTHEST where that is not known."""
        newest, _ = _mean(self.recent[-NEWEST:], self.lived[-NEWEST:])
        return jnp.where(self.sure[1], jnp.abs(newest - self.kept[1]), FARTHEST)

    def doubting(self, begins: Bool[Array, " P"], ends: Bool[Array, " P"], steady: Bool[Array, " P"]) -> "Memory":
        """Update which pairs are suspected.

        What came lately may have been wrong before it was doubted: of the newest beats none is believed then, and of
        those before them none but the reference, where the pair is `steady` and it does not age. After a doubt what a
        jump is from has to be learned anew.
        """
        starts, over = begins & (self.doubted <= 0), ends & ~begins & (self.doubted > 0)
        anew = (starts & steady)[None]
        return self._replace(
            clean=self.clean & ~starts[None],
            past=jnp.where(anew, self.kept[1][None], self.past),
            trusted=jnp.where(anew, self.sure[1][None], self.trusted),
            sure=jnp.stack([self.sure[0] & ~over, self.sure[1]]),
            doubted=jnp.where(begins, jnp.maximum(self.doubted, LEAST_S), jnp.where(ends, 0.0, self.doubted)),
        )

    def forgotten(self, pairs: Bool[Array, " P"]) -> "Memory":
        """Forget everything about these pairs."""
        return self._replace(
            total=jnp.where(pairs, 0.0, self.total),
            many=jnp.where(pairs, 0.0, self.many),
            lived=self.lived & ~pairs[None],
            clean=self.clean & ~pairs[None],
            trusted=self.trusted & ~pairs[None],
            sure=self.sure & ~pairs[None],
            doubted=jnp.where(pairs, 0.0, self.doubted),
        )


def _mean(beats: Float[Array, "B P"], there: Bool[Array, "B P"]) -> tuple[Float[Array, " P"], Float[Array, " P"]]:
    """Mean of the values that exist, and their number."""
    many = there.astype(beats.dtype).sum(axis=0)
    return jnp.where(there, beats, 0.0).sum(axis=0) / jnp.maximum(many, 1), many
