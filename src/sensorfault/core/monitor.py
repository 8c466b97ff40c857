"""The loop: residual, tests, decision, exclusion, recovery, and back into every state; the only place it closes."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int, Int8

from sensorfault.core.stage import Stage, keep_finite
from sensorfault.core.types import (
    FAULT,
    NEVER,
    OK,
    UNKNOWN,
    Accusation,
    Evidence,
    Report,
    Residual,
    Sample,
    Score,
    Trust,
    Verdict,
)

ABSURD = 1e30  # no sensor measures more [SI]
SUBJECTS = ("sensor", "motion")


class Branch(eqx.Module):
    """One way of judging the residual: a test statistic and its threshold.

    `gates`: an alarm of this branch may keep the present sample out of the filter. A window's alarm must not: it is
    about the past. `certain`: it accuses by itself (an exact repeat), so all it accuses are taken out at once, before
    the largest of the others is looked for. `subject`: "motion" for a branch that judges the vehicle instead of its
    sensors. Such a branch is not judged while a sensor is at fault, nor for `memory_s` after [s]. A sensor's branch
    with a memory presumes that the vehicle moves like its model, so it is not judged while a branch that `excuses`
    finds the motion at fault, nor for `memory_s` after. A branch excuses if no sensor fault can raise its alarm.
    """

    statistic: Stage[Any, Residual, Score, Any]
    threshold: Stage[Any, tuple[Residual, Score], Float[Array, " K"], Any]
    gates: bool = eqx.field(static=True, default=True)
    certain: bool = eqx.field(static=True, default=False)
    subject: str = eqx.field(static=True, default="sensor")
    memory_s: float = eqx.field(static=True, default=0.0)
    excuses: bool = eqx.field(static=True, default=False)

    def __check_init__(self) -> None:
        if self.subject not in SUBJECTS:
            raise ValueError(f"branch: subject is '{self.subject}'; take one of {', '.join(SUBJECTS)}")


class MonitorState(NamedTuple):
    """The states of the parts; of each channel the last value and its time, the last verdict and its test's time.

    Of the motion the last verdict and its time, when a sensor was last at fault, and when the vehicle last slid.
    """

    residual: Any
    branches: tuple[tuple[Any, Any], ...]
    decision: Any
    recovery: Any
    last: Float[Array, " C"]
    seen: Float[Array, " C"]
    verdict: Int8[Array, " C"]
    tested: Float[Array, " C"]
    motion: Int8[Array, ""]
    moved: Float[Array, ""]
    troubled: Float[Array, ""]
    slid: Float[Array, ""]


class _Judgement(NamedTuple):
    scores: tuple[Score, ...]
    limits: tuple[Float[Array, " K"], ...]
    pending: tuple[tuple[Any, Any], ...]
    accusation: Accusation
    decided: Any


_Round = tuple[Accusation, Any, Bool[Array, " C"], Bool[Array, " C"], Int[Array, ""]]


class Monitor(eqx.Module):
    """A fitted residual generator with its branches of tests, decision and recovery, ready to run.

    `owner[c]` is the sensor of channel c. `most` bounds how many sensors one sample may exclude, largest first; a
    channel that is still accused then is *unknown*. With most = 0 all accused are named at once. `together`: a fault on
    one channel takes out its whole sensor (a fix), not only the channels accused (an axis of a gyro). `least`: no
    sensor is excluded once no more than so many channels remain (as few satellites as a position needs). `hold_s[c]`:
    for how long a value and a verdict stand without a new measurement [s]; 0 for a channel that comes with every
    sample.
    """

    residual: Stage[Any, Sample, Residual, Any]
    branches: tuple[Branch, ...]
    decision: Stage[Any, Evidence, Accusation, Any]
    recovery: Stage[Any, tuple[Sample, Residual, Verdict, Bool[Array, " C"]], Trust, Any]
    hold_s: Float[Array, " C"]
    owner: tuple[int, ...] = eqx.field(static=True)
    most: int = eqx.field(static=True, default=0)
    together: bool = eqx.field(static=True, default=True)
    least: int = eqx.field(static=True, default=0)

    def __repr__(self) -> str:
        tests = ", ".join(type(branch.statistic).__name__ for branch in self.branches)
        return f"<Monitor {len(self.owner)} channels: {type(self.residual).__name__} judged by {tests}>"

    def init(self) -> MonitorState:
        """State before the first sample."""
        channels = len(self.owner)
        return MonitorState(
            self.residual.init(),
            tuple((b.statistic.init(), b.threshold.init()) for b in self.branches),
            self.decision.init(),
            self.recovery.init(),
            jnp.zeros(channels),
            jnp.full(channels, NEVER, float),
            jnp.full(channels, UNKNOWN, jnp.int8),
            jnp.full(channels, NEVER, float),
            jnp.asarray(UNKNOWN, jnp.int8),
            *[jnp.asarray(NEVER, float)] * 3,
        )

    def step(self, state: MonitorState, sample: Sample) -> tuple[MonitorState, Report]:
        """Judge one sample, then let every part take in what it may."""
        silence = sample.time - state.seen
        sample, arrived = self._intake(state, sample, silence)
        residual, work = self.residual.evaluate(state.residual, sample)
        nobody = jnp.zeros(len(self.owner), bool)
        valid = residual.valid & sample.fresh & jnp.isfinite(residual.value)
        residual = residual._replace(valid=valid, out=nobody)

        first = self._judge(state, residual, nobody)
        accusation, decided, excluded, out = self._exclude(state, residual, first)
        verdict, tested, gated = self._verdict(state, sample, accusation, excluded, out)
        troubled = jnp.where(verdict.sample == FAULT, sample.time, state.troubled)
        motion, moved, slid = self._motion(state, sample, first, troubled)
        verdict = verdict._replace(motion=motion)
        trust, recovered = self.recovery.evaluate(state.recovery, (sample, residual, verdict, gated))
        trust = trust._replace(learn=trust.learn & ~accusation.suspect)

        # Evidence windows take what the first judgement saw, suspicious or not; the decision remembers the last one.
        branches = tuple(
            (keep_finite(b.statistic.update(s, trust), a), keep_finite(b.threshold.update(t, trust), c))
            for b, (s, t), (a, c) in zip(self.branches, first.pending, state.branches, strict=True)
        )
        after = MonitorState(
            residual=keep_finite(self.residual.update(work, trust), state.residual),
            branches=branches,
            decision=keep_finite(self.decision.update(decided, trust), state.decision),
            recovery=keep_finite(self.recovery.update(recovered, trust), state.recovery),
            last=sample.value,
            seen=jnp.where(arrived, sample.time, state.seen),
            verdict=verdict.channel,
            tested=tested,
            motion=motion,
            moved=moved,
            troubled=troubled,
            slid=slid,
        )
        return after, Report(residual, first.scores, first.limits, verdict, trust, silence)

    def _intake(
        self, state: MonitorState, sample: Sample, silence: Float[Array, " C"]
    ) -> tuple[Sample, Bool[Array, " C"]]:
        """A value that is not a number is absent; one that came within `hold_s` is held, not absent."""
        arrived = sample.present & jnp.isfinite(sample.value)
        held = (silence >= 0) & (silence <= self.hold_s) & ~sample.born
        # A number beyond all use stays a number: its square must be one, and it must be seen, not lost.
        value = jnp.where(arrived, jnp.clip(sample.value, -ABSURD, ABSURD), state.last)
        return sample._replace(value=value, present=arrived | held, fresh=sample.fresh & arrived), arrived

    def _judge(self, state: MonitorState, residual: Residual, excluded: Bool[Array, " C"]) -> _Judgement:
        scores, limits, pending = [], [], []
        for branch, (of_statistic, of_threshold) in zip(self.branches, state.branches, strict=True):
            score, s = branch.statistic.evaluate(of_statistic, residual)
            limit, t = branch.threshold.evaluate(of_threshold, (residual, score))
            valid = score.valid & ~jnp.isnan(score.value) & ~jnp.isnan(limit)
            if branch.subject == "sensor" and branch.memory_s > 0:
                since = residual.time - state.slid
                valid = valid & ~((since >= 0) & (since <= branch.memory_s))
            scores.append(score._replace(valid=valid))
            limits.append(limit)
            pending.append((s, t))
        of_sensors = [i for i, branch in enumerate(self.branches) if branch.subject == "sensor"]
        evidence = Evidence(
            time=residual.time,
            scores=tuple(scores[i] for i in of_sensors),
            limits=tuple(limits[i] for i in of_sensors),
            gates=tuple(self.branches[i].gates for i in of_sensors),
            certain=tuple(self.branches[i].certain for i in of_sensors),
            excluded=excluded,
            born=residual.born,
        )
        accusation, decided = self.decision.evaluate(state.decision, evidence)
        return _Judgement(tuple(scores), tuple(limits), tuple(pending), accusation, decided)

    def _exclude(
        self, state: MonitorState, residual: Residual, first: _Judgement
    ) -> tuple[Accusation, Any, Bool[Array, " C"], Bool[Array, " C"]]:
        """Take out the worst sensor and judge the rest again, up to `most` times. A healthy sample pays nothing.

        Returns the last judgement, the channels excluded (accused and taken out), and all channels taken out.
        """
        owner = jnp.asarray(self.owner)
        nobody = jnp.zeros(len(self.owner), bool)
        if not self.most:
            return first.accusation, first.decided, nobody, nobody

        def accused(accusation: Accusation, out: Bool[Array, " C"]) -> Bool[Array, " C"]:
            return accusation.gated & (accusation.size > -jnp.inf) & ~out

        def more(carry: _Round) -> Bool[Array, ""]:
            accusation, _, _, out, rounds = carry
            going = accused(accusation, out).any() & (rounds < self.most)
            return going & ((residual.valid & ~out).sum() > self.least) if self.least else going

        def strike(carry: _Round) -> _Round:
            accusation, _, excluded, out, rounds = carry
            now = accused(accusation, out)
            sure = now & accusation.certain
            worst = owner == owner[jnp.argmax(jnp.where(now, accusation.size, -jnp.inf))]
            taken = jnp.where(sure.any(), sure, now & worst)
            excluded = excluded | taken
            out = out | taken
            if self.together:
                out = out | (out[None] & (owner[:, None] == owner[None])).any(axis=1)
            again = self._judge(state, residual._replace(valid=residual.valid & ~out, out=out), excluded)
            return again.accusation, again.decided, excluded, out, rounds + 1

        start = first.accusation, first.decided, nobody, nobody, jnp.zeros((), jnp.int32)
        accusation, decided, excluded, out, _ = lax.while_loop(more, strike, start)
        return accusation, decided, excluded, out

    def _verdict(
        self,
        state: MonitorState,
        sample: Sample,
        accusation: Accusation,
        excluded: Bool[Array, " C"],
        out: Bool[Array, " C"],
    ) -> tuple[Verdict, Float[Array, " C"], Bool[Array, " C"]]:
        """Three-valued verdicts, when each channel was last tested, and which channels a filter must not take in."""
        # Accused by this sample's own scores, but no exclusion is left: unknown, not ok.
        left = accusation.gated & (accusation.size > -jnp.inf) & ~excluded & bool(self.most)
        bad = accusation.named & ~left
        clear = accusation.tested & ~left & ~out & ~accusation.unattributed
        # Without a new test the last verdict stands for hold_s, unless the slot now carries another source.
        age = sample.time - state.tested
        stands = ~accusation.tested & ~out & ~sample.born & (age >= 0) & (age <= self.hold_s)
        old = jnp.where(stands, state.verdict, jnp.int8(UNKNOWN))
        channel = jnp.where(bad, jnp.int8(FAULT), jnp.where(clear, jnp.int8(OK), old))
        # the largest over a sensor's channels, without a scatter, which no small loop may hold
        mine = jnp.arange(max(self.owner) + 1)[:, None] == jnp.asarray(self.owner)[None]
        sensor = jnp.where(mine, channel[None], jnp.int8(OK)).max(axis=1)
        known = (channel != UNKNOWN).any()
        wrong = accusation.hit | (channel == FAULT).any()
        whole = jnp.where(wrong, jnp.int8(FAULT), jnp.where(known, jnp.int8(OK), jnp.int8(UNKNOWN)))
        tested = jnp.where(accusation.tested, sample.time, state.tested)
        return Verdict(channel, sensor, whole, state.motion), tested, accusation.gated | out | left

    def _motion(
        self, state: MonitorState, sample: Sample, judged: _Judgement, troubled: Float[Array, ""]
    ) -> tuple[Int8[Array, ""], Float[Array, ""], Float[Array, ""]]:
        """The verdict on the vehicle's motion, by tests whose evidence no faulty sensor touched, its time, and when
        the vehicle last slid.
        """
        tested = wrong = slides = jnp.zeros((), bool)
        spoiled = jnp.zeros((), bool)
        for branch, score, limit in zip(self.branches, judged.scores, judged.limits, strict=True):
            if branch.subject == "motion":
                clean = sample.time - troubled > branch.memory_s
                tested |= clean & score.valid.any()
                over = clean & (score.valid & (score.value > limit)).any()
                wrong |= over
                slides |= over & branch.excuses
                spoiled |= ~clean
        age = sample.time - state.moved
        stands = (age >= 0) & (age <= self.hold_s.max()) & ~spoiled
        old = jnp.where(stands, state.motion, jnp.int8(UNKNOWN))
        new = jnp.where(wrong, jnp.int8(FAULT), jnp.int8(OK))
        moved = jnp.where(tested, sample.time, state.moved)
        return jnp.where(tested, new, old), moved, jnp.where(slides, sample.time, state.slid)
