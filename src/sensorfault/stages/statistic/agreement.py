"""Which of several sensors that should agree is faulty: named only if no other explains all disagreements."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from sensorfault.core.types import NEVER, Residual, Score, Trust
from sensorfault.numerics.blocks import EARLY
from sensorfault.numerics.columns import picked
from sensorfault.numerics.pairwise_difference import PAST, RECENT, Memory


class _State(NamedTuple):
    climbed: Float[Array, " W"]  # integral of each vertical speed [m]
    speed: Float[Array, " W"]  # newest [m/s]
    spoken: Float[Array, " W"]  # when each witness last did [s]
    memory: Memory
    excused: Bool[Array, ""]  # all heights, by the last sample: vertical speeds alone were accused


class _Work(NamedTuple):
    state: _State
    fresh: Bool[Array, " C"]
    suspect: Bool[Array, " W"]  # takes part in a disagreement, unless the heights are excused
    excused: Bool[Array, ""]  # now
    healed: Bool[Array, ""]  # two heights agree again after a long doubt


class Agreement(eqx.Module):
    """|gap| / (limit growth) of each two witnesses of one height: of a jump, and of a drift over a minute.

    Heights are compared with each other and with what vertical speeds add up to, each time the first witness is new,
    and averaged over beats of `beat_s`: numerics/pairwise_difference.py. (Wang et al. watch windows of 3 s, in which a
    drift of 0.1 m/s is 0.3 m; over a minute it is 5 m.) While either of a pair is under suspicion its references stay;
    after `afresh_s` all is forgotten, else a witness set anew would be accused for ever. A vertical speed always has a
    bias: its sum may be off by more the older the reference is, and begins anew after a long doubt.

    A sensor is accused if it takes part in every disagreement and no other sensor does. Two of one sensor that disagree
    accuse it, whatever others say; two sensors that disagree while no third can decide stay unaccused: the sample is at
    fault, unknown which. Of the accused sensor those channels are named that take part in every disagreement, or, if
    none does, all that take part in one. For residual/two_heights.py.
    """

    limit: Float[Array, "2 P"]  # [m]
    upward: Float[Array, " W"]  # 0 for a height, 1 or -1 for a vertical speed
    beat_s: Float[Array, ""]
    gap_s: Float[Array, ""]  # of the first witness, or of a vertical speed
    afresh_s: Float[Array, ""]
    columns: tuple[int, ...] = eqx.field(static=True)
    pairs: tuple[tuple[int, int], ...] = eqx.field(static=True)  # of witnesses, the first before the second
    owner: tuple[int, ...] = eqx.field(static=True)  # whose channels may be wrong together

    def init(self) -> _State:
        none = jnp.zeros(len(self.columns))
        return _State(
            none, none, jnp.full(none.shape, NEVER), Memory.empty(len(self.pairs), jnp.asarray(NEVER)), none[0] > 0
        )

    def evaluate(self, state: _State, residual: Residual) -> tuple[Score, _Work]:
        fresh, present = residual.extra
        now = residual.time
        state, height, there = self._received(state, residual)
        i, j = self._sides()
        lead = fresh[self.columns[0]]
        memory = state.memory.received(there[i] & there[j] & lead, height[i] - height[j])
        memory = memory.beaten(lead & (now - memory.began >= (1 - EARLY) * self.beat_s), now)
        gap, known = memory.gaps()
        covers = self._covers()
        out = (covers & jnp.broadcast_to(jnp.asarray(residual.out), fresh.shape)[None]).any(axis=1)
        here = picked(present, self.columns)
        known = known & (here[i] & here[j] & here[0] & ~out)[None]
        growth = jnp.where(self._speaks(), 1 + memory.doubted / ((RECENT + PAST) * self.beat_s), 1.0)
        jump, drift = jnp.abs(gap) / (self.limit * growth[None])
        # After a long doubt what a jump is from may be wrong; two heights that have not drifted have not jumped either.
        long = (memory.doubted > RECENT * self.beat_s) & ~self._speaks()
        value = jnp.stack([jnp.where(long, jnp.minimum(jump, memory.since() / self.limit[1]), jump), drift])
        over = (known & (value > 1)).any(axis=0)
        accused = named(over, covers, self.owner)
        # below these limits nobody disagrees; a lower one, set from outside, accuses both
        blame = covers & (accused | ~over.any())[None]
        who, where = picked(accused, self.columns), (over[:, None] & covers).any(axis=0)
        excused = who.any() & ~(who & (self.upward == 0)).any()
        suspect = picked(where, self.columns) & ~excused
        healed = (long & known[1] & ~over).any()
        twice = jnp.concatenate([covers, covers]), jnp.concatenate([blame, blame]).astype(value.dtype)
        work = _Work(state._replace(memory=memory), fresh, suspect, excused, healed)
        return Score(value.ravel(), known.ravel(), *twice), work

    def update(self, work: _Work, trust: Trust) -> _State:
        memory = work.state.memory
        # A height that is kept out, or that disagrees, is in doubt until it agrees again. A vertical speed is not:
        # what it has added up to stays wrong after it is right again.
        new = picked(work.fresh, self.columns)
        bad = (work.suspect | (new & ~picked(trust.measured, self.columns))) & (self.upward == 0)
        i, j = self._sides()
        begins = bad[i] | bad[j]
        ends = new[0] & ~begins
        after = memory.doubting(begins, ends, ~self._speaks())
        # what a speed has added up to since is no longer near the reference of before
        strayed = ends & (memory.doubted > RECENT * self.beat_s)
        strayed = strayed | work.healed | (work.state.excused & ~work.excused)
        lost = (strayed & self._speaks()) | (after.doubted > self.afresh_s)
        return work.state._replace(memory=after.forgotten(lost), excused=work.excused)

    def _sides(self) -> tuple[Int[Array, " P"], Int[Array, " P"]]:
        """The witnesses of each pair."""
        first, second = zip(*self.pairs, strict=True)
        return jnp.asarray(first), jnp.asarray(second)

    def _covers(self) -> Bool[Array, "P C"]:
        channels, columns = jnp.arange(len(self.owner)), jnp.asarray(self.columns)
        i, j = self._sides()
        return (channels[None] == columns[i][:, None]) | (channels[None] == columns[j][:, None])

    def _speaks(self) -> Bool[Array, " P"]:
        """Pairs of which one is a vertical speed."""
        i, j = self._sides()
        return (self.upward[i] != 0) | (self.upward[j] != 0)

    def _received(self, state: _State, residual: Residual) -> tuple[_State, Float[Array, " W"], Bool[Array, " W"]]:
        """With what each witness measures now: a height, or the sum of its speed [m]."""
        now = residual.time
        value, fresh, present, born = (
            picked(x, self.columns)
            for x in (residual.measured, residual.extra.fresh, residual.extra.present, residual.born)
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
        received = _State(climbed, jnp.where(fresh, speed, state.speed), spoken, memory, state.excused)
        late = jnp.clip(now - spoken, 0.0, self.gap_s)
        height = jnp.where(speaks, climbed + received.speed * late, value)
        return received, height, jnp.where(speaks, now - spoken <= self.gap_s, present)


def named(over: Bool[Array, " P"], covers: Bool[Array, "P C"], owner: tuple[int, ...]) -> Bool[Array, " C"]:
    """Whom these disagreements accuse, `covers` saying who takes part in which and `owner` of which sensor each is."""
    sensor = jnp.asarray(owner)
    same = sensor[:, None] == sensor[None]
    touched = (covers[:, :, None] & same[None]).any(axis=1)  # pair by channel: of a sensor that takes part
    explains = over.any() & (~over[:, None] | touched).all(axis=0)  # each channel: its sensor does, everywhere
    alone = explains & ~(explains[None] & ~same).any(axis=1)
    always = alone & (~over[:, None] | covers).all(axis=0)
    once = alone & (over[:, None] & covers).any(axis=0)
    return jnp.where(always.any(), always, once)
