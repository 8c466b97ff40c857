"""The catalog's small parts against loops in NumPy, on random logs with holes, holds and repeats."""

import functools

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from core.scripted import FromBlock, Said
from laws.walk import Walk, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Residual, Score
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax

LONG, CHANNELS = 60, 3
SCALE = np.array([0.5, 1.0, 2.0])
LARGEST = 1.3
HOLD_S, HORIZON_S, READMIT_S = 0.25, 1.0, 0.35
seeds = st.integers(0, 2**32 - 1)
chances = st.floats(0.0, 0.9)


class Log:
    """Values on a coarse grid, so that they repeat; expected values; holes; and rows that are held."""

    def __init__(self, seed: int, missing: float, held: float) -> None:
        rng = np.random.default_rng(seed)
        self.time = np.cumsum(rng.choice([0.1, 0.2], LONG))
        self.value = rng.integers(-3, 4, (LONG, CHANNELS)) / 2.0
        self.value[rng.random((LONG, CHANNELS)) < missing] = np.nan
        self.fresh = (rng.random((LONG, CHANNELS)) >= held) & ~np.isnan(self.value)
        self.expected = 0.1 * rng.standard_normal((LONG, CHANNELS))

    def through(self, monitor: Monitor) -> Walk:
        rows = samples(self.time, self.value, self.fresh, Said((np.zeros((LONG, 1)),), self.expected))
        return walk(monitor, rows)


@functools.cache
def norm_monitor() -> Monitor:
    branch = Branch(Norm(jnp.asarray(SCALE)), ScaledMax(jnp.array([LARGEST])))
    rebuild = Rebuild(jnp.asarray(HORIZON_S), jnp.asarray(READMIT_S), CHANNELS)
    return Monitor(FromBlock(CHANNELS), (branch,), Exceed(), rebuild, jnp.full(CHANNELS, HOLD_S), (0, 0, 1))


@settings(max_examples=40, deadline=None)
@given(seeds, chances, chances)
def test_norm_scaled_max_exceed_rebuild(seed: int, missing: float, held: float) -> None:
    log = Log(seed, missing, held)
    result = log.through(norm_monitor())
    named, tested_at, healthy_at, accused_at, seen_at = (
        [False] * CHANNELS,
        *([-np.inf] * CHANNELS for _ in range(4)),
    )
    for k, t in enumerate(log.time):
        fresh = [c for c in range(CHANNELS) if log.fresh[k, c]]
        error = {c: (log.value[k, c] - log.expected[k, c]) / SCALE[c] for c in fresh}
        score = sum(e**2 for e in error.values()) ** 0.5
        limit = LARGEST * (1 + 1 / (1 + np.exp(score)))
        assert result.reports.scores[0].valid[k, 0] == bool(fresh)
        if fresh:
            np.testing.assert_allclose(result.reports.scores[0].value[k, 0], score, rtol=1e-12)
            np.testing.assert_allclose(result.reports.limits[0][k, 0], limit, rtol=1e-12)
        alarm = bool(fresh) and score > limit
        most = max((e**2 for e in error.values()), default=0.0)
        verdict = []
        for c in range(CHANNELS):
            if c in fresh:
                named[c], tested_at[c] = alarm and error[c] ** 2 >= 0.5 * most, t
            verdict.append((FAULT if named[c] else OK) if t - tested_at[c] <= HOLD_S else UNKNOWN)
        sample = FAULT if FAULT in verdict else OK if OK in verdict else UNKNOWN
        np.testing.assert_array_equal(result.channel[k], verdict)
        np.testing.assert_array_equal(result.sensor[k], [max(verdict[:2]), verdict[2]])
        assert result.sample[k] == sample
        trust = result.reports.trust
        for c in range(CHANNELS):
            if alarm and c in fresh and named[c]:
                accused_at[c] = t
            arrived = not np.isnan(log.value[k, c])
            present = arrived or t - seen_at[c] <= HOLD_S
            seen_at[c] = t if arrived else seen_at[c]
            standing = c not in fresh and present and verdict[c] == FAULT and accused_at[c] >= healthy_at[c]
            doubted = t - accused_at[c] <= READMIT_S or standing
            if c in fresh and not doubted:
                healthy_at[c] = t
            filled = doubted and present and t - healthy_at[c] <= HORIZON_S
            assert trust.measured[k, c] == (c in fresh and not doubted)
            assert trust.filled[k, c] == filled
            assert trust.learn[k, c] == (trust.measured[k, c] and verdict[c] == OK and sample == OK)
            if not np.isnan(log.value[k, c]):
                assert trust.value[k, c] == (log.expected if filled else log.value)[k, c]


@functools.cache
def repeats_monitor() -> Monitor:
    branch = Branch(Repeats(CHANNELS), Fixed(jnp.zeros(CHANNELS)))
    rebuild = Rebuild(jnp.asarray(HORIZON_S), jnp.asarray(READMIT_S), CHANNELS)
    return Monitor(FromBlock(CHANNELS), (branch,), Exceed(), rebuild, jnp.full(CHANNELS, HOLD_S), (0, 1, 2))


@settings(max_examples=40, deadline=None)
@given(seeds, chances, chances)
def test_repeats(seed: int, missing: float, held: float) -> None:
    log = Log(seed, missing, held)
    result = log.through(repeats_monitor())
    for c in range(CHANNELS):
        last, run, tested_at = None, 0, -np.inf
        for k, t in enumerate(log.time):
            if log.fresh[k, c]:
                run = run + 1 if log.value[k, c] == last else 0
                last, tested_at = log.value[k, c], t
                assert result.reports.scores[0].value[k, c] == run
            verdict = (FAULT if run else OK) if t - tested_at <= HOLD_S else UNKNOWN
            assert result.channel[k, c] == verdict


fixed_point = jax.jit(lambda rule: rule.fixed_point())


@jax.jit
def limit_for(rule: ScaledMax, value):
    score = Score(value, jnp.ones(1, bool), jnp.ones((1, 1), bool), jnp.ones((1, 1)))
    one, each, no = jnp.ones(1), jnp.ones(1, bool), jnp.zeros(1, bool)
    return rule.evaluate((), (Residual(jnp.zeros(()), one, one[None], one, one, one, each, no), score))[0]


@settings(max_examples=100, deadline=None)
@given(st.floats(1e-6, 1e3), st.floats(0.0, 2.0))
def test_scaled_max_is_one_fixed_limit(largest: float, times: float) -> None:
    def excess(e: float) -> float:
        return e - largest * (1 + 1 / (1 + np.exp(min(e, 700.0))))

    root = brentq(excess, largest, 1.5 * largest, xtol=1e-15, rtol=1e-15)
    rule = ScaledMax(jnp.array([largest]))
    fixed, score = fixed_point(rule)[0], times * largest
    np.testing.assert_allclose(fixed, root, rtol=1e-12)
    if abs(score - root) > 1e-9 * root:
        assert (score > limit_for(rule, np.array([score]))[0]) == (score > fixed)
