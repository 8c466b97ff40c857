"""Witnesses of one height: how far each two of them have moved apart since they were last believed."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from sensorfault.numerics.apart import PAST, RECENT, Memory
from sensorfault.types import NEVER, Residual, Sample, Trust

EARLY = 0.1  # share of a beat by which a fix may come early and still close it: receivers jitter


class Apart(NamedTuple):
    """A jump and a drift of each pair: how far its newest beats are from their reference [m], and whether it is known.

    `growth`: by how much more than usual a pair may be apart by now, because its reference is that much older.
    """

    gap: Float[Array, "2 P"]
    known: Bool[Array, "2 P"]
    growth: Float[Array, " P"]


class _State(NamedTuple):
    climbed: Float[Array, " W"]  # integral of each vertical speed [m]
    speed: Float[Array, " W"]  # newest [m/s]
    spoken: Float[Array, " W"]  # when each witness last did [s]
    memory: Memory


class _Work(NamedTuple):
    state: _State
    fresh: Bool[Array, " C"]


class HeightWitnesses(eqx.Module):
    """Differences of heights, and of climbs that vertical speeds add up to, pair by pair.

    Each time the first witness speaks, all that are there are compared; the differences are averaged over beats of
    `beat_s`. The newest two are held against those before them, and the newest ten against the oldest ten of a minute
    (Wang et al. watch windows of 3 s, in which a drift of 0.1 m/s is 0.3 m; over a minute it is 5 m). While either of a
    pair is under suspicion both references stay, so that a drift that ends is not forgotten and one that is repaired
    leaves nothing behind. After `afresh_s` all is forgotten, else a witness set anew would be accused for ever.

    A vertical speed is never without a bias, so what it adds up to may be off by the more the older the reference is,
    and begins anew after a long doubt. What is expected of a height is what the other one says, moved by their
    reference; of a vertical speed, nothing.
    """

    upward: Float[Array, " W"]  # 0 for a height, 1 or -1 for a vertical speed
    beat_s: Float[Array, ""]
    gap_s: Float[Array, ""]  # of the first witness, or of a vertical speed
    afresh_s: Float[Array, ""]
    variance: Float[Array, " C"]  # of what is expected, while the reference is new [SI^2]
    columns: tuple[int, ...] = eqx.field(static=True)
    pairs: tuple[tuple[int, int], ...] = eqx.field(static=True)  # of witnesses, the first before the second
    stands_in: tuple[tuple[int, int, float], ...] = eqx.field(static=True)  # witness, pair, sign of its reference

    def init(self) -> _State:
        none = jnp.zeros(len(self.columns))
        return _State(none, none, jnp.full(none.shape, NEVER), Memory.empty(len(self.pairs), jnp.asarray(NEVER)))

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        state, height, there = self._heard(state, sample)
        i, j = self._sides()
        lead = sample.fresh[self.columns[0]]
        memory = state.memory.heard(there[i] & there[j] & lead, height[i] - height[j])
        over = lead & (sample.time - memory.began >= (1 - EARLY) * self.beat_s)
        memory = memory.beaten(over, sample.time)
        gap, known = memory.gaps()
        current = sample.time - state.spoken[0] <= self.gap_s
        ageing = 1 + memory.doubted / self._span_s()
        expected, stands = self._expected(memory, sample.value, height, there)
        mine = jnp.asarray([c in self.columns for c in range(sample.value.size)])
        variance = jnp.where(mine, self.variance * ageing.max() ** 2, 1.0)
        residual = Residual(
            time=sample.time,
            value=jnp.where(stands, sample.value - expected, 0.0),
            cov=jnp.diag(variance),
            measured=sample.value,
            expected=expected,
            noise=variance,
            valid=sample.fresh & stands,
            born=sample.born,
            extra=Apart(gap, known & current, jnp.where(self._speaks(), ageing, 1.0)),
        )
        return residual, _Work(state._replace(memory=memory), sample.fresh)

    def update(self, work: _Work, trust: Trust) -> _State:
        memory = work.state.memory
        # What is kept out doubts its pairs, and what is under suspicion those that can be judged; what is believed
        # ends the doubt.
        out, bad, good = (
            jnp.stack([x[c] for c in self.columns])
            for x in (work.fresh & ~trust.measured, work.fresh & ~trust.learn, trust.learn)
        )
        i, j = self._sides()
        ends = (good[i] | good[j]) & ~bad[i] & ~bad[j]
        after = memory.doubting(out[i] | out[j] | (memory.sure.any(axis=0) & (bad[i] | bad[j])), ends)
        # what a speed has added up to since is no longer near the reference of before
        strayed = ends & (memory.doubted > RECENT * self.beat_s) & self._speaks()
        return work.state._replace(memory=after.forgotten(strayed | (after.doubted > self.afresh_s)))

    def _sides(self) -> tuple[Int[Array, " P"], Int[Array, " P"]]:
        """The witnesses of each pair."""
        first, second = zip(*self.pairs, strict=True)
        return jnp.asarray(first), jnp.asarray(second)

    def _speaks(self) -> Bool[Array, " P"]:
        """Pairs of which one is a vertical speed."""
        i, j = self._sides()
        return (self.upward[i] != 0) | (self.upward[j] != 0)

    def _span_s(self) -> Float[Array, ""]:
        return (RECENT + PAST) * self.beat_s

    def _heard(self, state: _State, sample: Sample) -> tuple[_State, Float[Array, " W"], Bool[Array, " W"]]:
        """With what each witness says now: a height, or what its speed has added up to [m]."""
        now = sample.time
        value, fresh, present, born = (
            jnp.stack([x[c] for c in self.columns]) for x in (sample.value, sample.fresh, sample.present, sample.born)
        )
        speaks = self.upward != 0
        dt = now - state.spoken
        follows = (dt > 0) & (dt <= self.gap_s) & ~born
        speed = self.upward * value
        # c(k) = c(k-1) + (v(k) + v(k-1)) Δt / 2
        gained = jnp.where(follows, (speed + state.speed) / 2 * dt, 0.0)
        climbed = jnp.where(fresh & speaks, state.climbed + gained, state.climbed)
        broken = jnp.where(speaks, fresh & ~follows, born)
        hole = fresh[0] & ((dt[0] <= 0) | (dt[0] > self.gap_s))
        i, j = self._sides()
        memory = state.memory.forgotten(broken[i] | broken[j] | hole)
        memory = memory._replace(began=jnp.where(hole, now, memory.began))
        spoken = jnp.where(fresh, now, state.spoken)
        heard = _State(climbed, jnp.where(fresh, speed, state.speed), spoken, memory)
        late = jnp.clip(now - spoken, 0.0, self.gap_s)
        height = jnp.where(speaks, climbed + heard.speed * late, value)
        return heard, height, jnp.where(speaks, now - spoken <= self.gap_s, present)

    def _expected(
        self, memory: Memory, value: Float[Array, " C"], height: Float[Array, " W"], there: Bool[Array, " W"]
    ) -> tuple[Float[Array, " C"], Bool[Array, " C"]]:
        """Of each height, by the one that stands in for it, and whether there is one to."""
        expected, known = value, jnp.zeros(value.shape, bool)
        for w, pair, sign in self.stands_in:
            other = self.pairs[pair][1] if self.pairs[pair][0] == w else self.pairs[pair][0]
            good = (jnp.arange(value.size) == self.columns[w]) & memory.sure[1, pair] & there[other]
            # ĝ = b + (g - b), as it was when both were believed
            expected = jnp.where(good, height[other] + sign * memory.kept[1, pair], expected)
            known = known | good
        return expected, known
