"""Witnesses of one height: how far each two of them have moved apart since they were last believed."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from sensorfault.types import NEVER, Residual, Sample, Trust

RECENT, PAST, OLDEST = 10, 50, 10  # beats: the newest, those remembered before, and of these the reference's
NEWEST, ENOUGH = 2, 4  # beats that a jump is seen in; of those before it in RECENT so many must be believed


class Apart(NamedTuple):
    """A jump and a drift of each pair: how far its newest beats are from their reference [m], and whether it is known.

    `growth`: by how much more than usual a pair may be apart by now, because its reference is that much older.
    """

    gap: Float[Array, "2 P"]
    known: Bool[Array, "2 P"]
    growth: Float[Array, " P"]


class _State(NamedTuple):
    time: Float[Array, ""]  # of the last sample [s]
    climbed: Float[Array, " W"]  # integral of each vertical speed [m]
    speed: Float[Array, " W"]  # newest [m/s]
    spoken: Float[Array, " W"]  # when it came [s]
    fixed: Float[Array, ""]  # when the first witness last spoke [s]
    began: Float[Array, ""]  # this beat [s]
    total: Float[Array, " P"]  # of the differences in this beat [m]
    count: Float[Array, " P"]
    recent: Float[Array, "R P"]  # the newest beats' means, the newest last [m]
    lived: Int[Array, "R P"]  # 1 where there was one
    clean: Int[Array, "R P"]  # 1 where it was believed
    past: Float[Array, "Q P"]  # what was believed before them [m]
    trusted: Int[Array, "Q P"]
    kept: Float[Array, "2 P"]  # the references in use [m]: of some seconds ago, and of a minute
    sure: Bool[Array, "2 P"]
    doubted: Float[Array, " P"]  # for how long it has been held [s]


class _Work(NamedTuple):
    state: _State
    fresh: Bool[Array, " C"]
    beat: Bool[Array, ""]


class HeightWitnesses(eqx.Module):
    """Differences of heights, and of climbs that vertical speeds add up to, pair by pair.

    Each time the first witness speaks, all that are there are compared; the differences are averaged over beats of
    `beat_s`. The newest two are held against those before them, and the newest ten against the oldest ten of a minute
    (Wang et al. watch windows of 3 s, in which a drift of 0.1 m/s is 0.3 m; over a minute it is 5 m). While either of a
    pair is under suspicion both references stay as they were, and take the place of what would be remembered, so that
    a drift that ends is not forgotten and one that is repaired leaves nothing behind. After `afresh_s` all is
    forgotten, else a witness that was set anew would be accused for ever.

    A vertical speed is never without a bias, so what it adds up to may be off by the more the older the reference is.
    What is expected of a height is what the next one says, moved by their reference; of a vertical speed, nothing.
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
        w, p, never = len(self.columns), len(self.pairs), jnp.asarray(NEVER, float)
        none = jnp.zeros(p)
        recent, past = jnp.zeros((RECENT, p)), jnp.zeros((PAST, p))
        return _State(
            time=never,
            climbed=jnp.zeros(w),
            speed=jnp.zeros(w),
            spoken=jnp.full(w, NEVER, float),
            fixed=never,
            began=never,
            total=none,
            count=none,
            recent=recent,
            lived=recent.astype(int),
            clean=recent.astype(int),
            past=past,
            trusted=past.astype(int),
            kept=jnp.zeros((2, p)),
            sure=jnp.zeros((2, p), bool),
            doubted=none,
        )

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        state, height, there = self._heard(state, sample)
        first = jnp.asarray([i for i, _ in self.pairs]), jnp.asarray([j for _, j in self.pairs])
        difference = height[first[0]] - height[first[1]]
        both = there[first[0]] & there[first[1]] & sample.fresh[self.columns[0]]
        beat = sample.fresh[self.columns[0]] & (sample.time - state.began >= self.beat_s)
        state = _chosen(beat, self._pushed(state), state)
        state = state._replace(
            total=jnp.where(both, state.total + difference, state.total),
            count=jnp.where(both, state.count + 1, state.count),
        )
        apart = self._apart(state)
        expected, known = self._expected(state, sample, there)
        mine = jnp.asarray([c in self.columns for c in range(sample.value.size)])
        age = 1 + jnp.max(state.doubted) / self._span_s()
        variance = jnp.where(mine, self.variance * age**2, 1.0)
        residual = Residual(
            time=sample.time,
            value=jnp.where(known, sample.value - expected, 0.0),
            cov=jnp.diag(variance),
            measured=sample.value,
            expected=expected,
            noise=variance,
            valid=sample.fresh & known,
            born=sample.born,
            extra=apart,
        )
        return residual, _Work(state, sample.fresh, beat)

    def update(self, work: _Work, trust: Trust) -> _State:
        state = work.state
        # What is kept out doubts its pairs, and what is under suspicion those that can be judged; what is believed
        # ends the doubt.
        out, bad, good = (
            jnp.stack([x[c] for c in self.columns])
            for x in (work.fresh & ~trust.measured, work.fresh & ~trust.learn, trust.learn)
        )
        i, j = (jnp.asarray(side) for side in zip(*self.pairs, strict=True))
        begins = out[i] | out[j] | (state.sure.any(axis=0) & (bad[i] | bad[j]))
        ends = (good[i] | good[j]) & ~bad[i] & ~bad[j]
        doubt = jnp.where(begins, jnp.maximum(state.doubted, 1e-6), jnp.where(ends, 0.0, state.doubted))
        anew = doubt > self.afresh_s
        return state._replace(
            doubted=jnp.where(anew, 0.0, doubt),
            **_void(state, anew),
        )

    def _span_s(self) -> Float[Array, ""]:
        return (RECENT + PAST) * self.beat_s

    def _heard(self, state: _State, sample: Sample) -> tuple[_State, Float[Array, " W"], Bool[Array, " W"]]:
        """With what each witness says now: a height, or what its speed has added up to [m]."""
        now = sample.time
        value, fresh, present, born = (
            jnp.stack([x[c] for c in self.columns]) for x in (sample.value, sample.fresh, sample.present, sample.born)
        )
        speaks = self.upward != 0
        # c(k) = c(k-1) + (v(k) + v(k-1)) Δt / 2
        dt = now - state.spoken
        follows = (dt > 0) & (dt <= self.gap_s) & ~born
        speed = self.upward * value
        gained = jnp.where(follows, (speed + state.speed) / 2 * dt, 0.0)
        climbed = jnp.where(fresh & speaks, state.climbed + gained, state.climbed)
        broken = jnp.where(speaks, fresh & ~follows, born)
        lead = sample.fresh[self.columns[0]]
        away = now - state.fixed
        hole = lead & ((away <= 0) | (away > self.gap_s))
        i, j = (jnp.asarray(side) for side in zip(*self.pairs, strict=True))
        void = broken[i] | broken[j] | hole
        heard = state._replace(
            time=now,
            climbed=climbed,
            speed=jnp.where(fresh, speed, state.speed),
            spoken=jnp.where(fresh, now, state.spoken),
            fixed=jnp.where(lead, now, state.fixed),
            began=jnp.where(hole, now, state.began),
            total=jnp.where(void, 0.0, state.total),
            count=jnp.where(void, 0.0, state.count),
            doubted=jnp.where(void, 0.0, state.doubted),
            **_void(state, void),
        )
        late = now - heard.spoken
        height = jnp.where(speaks, climbed + heard.speed * jnp.clip(late, 0.0, self.gap_s), value)
        return heard, height, jnp.where(speaks, late <= self.gap_s, present)

    def _pushed(self, state: _State) -> _State:
        """With the beat that is over in its place, and the next one begun."""
        mean = state.total / jnp.maximum(state.count, 1)
        held = state.doubted > 0
        lives = (state.count > 0).astype(int)
        # what leaves the newest beats without having been believed is remembered as its reference
        believed = state.clean[0] > 0
        leaving = jnp.where(believed, state.recent[0], state.kept[1])
        trusted = jnp.where(believed, 1, (held & state.sure[1]).astype(int))
        after = state._replace(
            began=state.fixed,
            total=jnp.zeros_like(state.total),
            count=jnp.zeros_like(state.count),
            recent=_shifted(state.recent, mean),
            lived=_shifted(state.lived, lives),
            clean=_shifted(state.clean, jnp.where(held, 0, lives)),
            past=_shifted(state.past, leaving),
            trusted=_shifted(state.trusted, trusted),
            doubted=jnp.where(held, state.doubted + (state.fixed - state.began), 0.0),
        )
        before, minute = after.clean[:-NEWEST], after.trusted[:OLDEST]
        many = jnp.stack([before.sum(axis=0), minute.sum(axis=0)])
        total = jnp.stack([(after.recent[:-NEWEST] * before).sum(axis=0), (after.past[:OLDEST] * minute).sum(axis=0)])
        enough = many >= jnp.asarray([[ENOUGH], [OLDEST // 2]])
        anew = enough & ~held[None]
        return after._replace(kept=jnp.where(anew, total / jnp.maximum(many, 1), state.kept), sure=state.sure | anew)

    def _apart(self, state: _State) -> Apart:
        gaps, known = [], []
        for length, kept, sure in zip((NEWEST, RECENT), state.kept, state.sure, strict=True):
            lived = state.lived[-length:]
            many = lived.sum(axis=0)
            gaps.append((state.recent[-length:] * lived).sum(axis=0) / jnp.maximum(many, 1) - kept)
            known.append(sure & (many >= (length + 1) // 2))
        i, j = (jnp.asarray(side) for side in zip(*self.pairs, strict=True))
        speaks = (self.upward[i] != 0) | (self.upward[j] != 0)
        growth = jnp.where(speaks, 1 + state.doubted / self._span_s(), 1.0)
        current = state.time - state.fixed <= self.gap_s
        return Apart(jnp.stack(gaps), jnp.stack(known) & current, growth)

    def _expected(
        self, state: _State, sample: Sample, there: Bool[Array, " W"]
    ) -> tuple[Float[Array, " C"], Bool[Array, " C"]]:
        """Of each height, by the witness that stands in for it, and whether there is one to."""
        expected, known = sample.value, jnp.zeros(sample.value.shape, bool)
        for w, pair, sign in self.stands_in:
            other = self.pairs[pair][1] if self.pairs[pair][0] == w else self.pairs[pair][0]
            mine = jnp.arange(sample.value.size) == self.columns[w]
            good = state.sure[1, pair] & there[other]
            # ĝ = b + (g - b) when both were believed
            value = sample.value[self.columns[other]] + sign * state.kept[1, pair]
            expected = jnp.where(mine & good, value, expected)
            known = known | (mine & good)
        return expected, known


def _shifted(ring: Array, new: Array) -> Array:
    return jnp.concatenate([ring[1:], new[None]])


def _void(state: _State, pairs: Bool[Array, " P"]) -> dict[str, Array]:
    """Nothing remembered of these pairs."""
    rings = {name: jnp.where(pairs, 0, getattr(state, name)) for name in ("lived", "clean", "trusted")}
    return {**rings, "sure": state.sure & ~pairs}


def _chosen(first: Bool[Array, ""], one: _State, other: _State) -> _State:
    return _State(*[jnp.where(first, a, b) for a, b in zip(one, other, strict=True)])
