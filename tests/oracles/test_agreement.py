"""Pairs of heights by lists of beats in plain Python; and who is named, by going through everyone."""

from itertools import combinations, product

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.core.types import Trust
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.two_heights import TwoHeights
from sensorfault.stages.statistic.agreement import Agreement, named

HEIGHT, BARO, DOWN = range(3)
PAIRS = ((0, 1), (0, 2), (1, 2))
BEAT_S, GAP_S, ROWS = 1.0, 3.0, 640


def log() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fixes at 2 Hz on a clock of 4 Hz, the barometer with most rows; a gap in the clock, a silence of down."""
    random = np.random.default_rng(5)
    time = np.arange(ROWS) / 4.0
    time[500:] += 5.0
    climb = np.sin(0.1 * time)
    height = 100 + 10 * (1 - np.cos(0.1 * time))
    value = np.column_stack([height, height - 50, -climb]) + 0.1 * random.standard_normal((ROWS, 3))
    fresh = np.ones((ROWS, 3), bool)
    fresh[1::2, [HEIGHT, DOWN]] = False
    fresh[random.random(ROWS) < 0.2, BARO] = False
    fresh[380:400, DOWN] = False
    value[~fresh] = np.nan
    return time, value, fresh


def agreement() -> Agreement:
    return Agreement(
        limit=jnp.full((2, 3), 1e6),
        upward=jnp.asarray([0.0, 0.0, -1.0]),
        beat_s=jnp.asarray(BEAT_S),
        gap_s=jnp.asarray(GAP_S),
        afresh_s=jnp.asarray(1e3),
        columns=(HEIGHT, BARO, DOWN),
        pairs=PAIRS,
        owner=(0, 1, 0),
    )


def result(doubted: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """By the package: gaps, which are known, and what is expected. Within `doubted` all is kept out."""
    time, value, fresh = log()
    rows = samples(time, np.where(fresh, value, 0.0), fresh)
    suspect = np.zeros(ROWS, bool)
    suspect[doubted] = True
    part = TwoHeights(jnp.asarray(20.0), jnp.asarray(1.0), (HEIGHT, BARO), (HEIGHT, BARO, DOWN), 3)
    statistic = agreement()

    def step(states, row):
        sample, doubt = row
        sample = sample._replace(present=sample.fresh)
        found, work = part.evaluate(states[0], sample)
        _, pending = statistic.evaluate(states[1], found)
        trust = Trust(sample.value, sample.fresh & ~doubt, sample.fresh & False, sample.fresh & ~doubt, sample.born)
        gaps = pending.state.memory.gaps()
        return (part.update(work, trust), statistic.update(pending, trust)), (*gaps, found.expected)

    start = part.init(), statistic.init()
    return jax.tree.map(np.asarray, jax.lax.scan(step, start, (rows, jnp.asarray(suspect)))[1])


def by_hand(doubted: slice) -> tuple[np.ndarray, np.ndarray]:
    """Gaps of jump and drift, NaN where unknown, after each fix."""
    time, value, fresh = log()
    gaps = np.full((ROWS, 2, 3), np.nan)
    climbed, speed, spoken, fixed, began = 0.0, 0.0, -1e12, -1e12, -1e12
    # of each pair: differences of this beat, newest beats (mean, believed), those before, references, length of doubt
    now: list[list[float]] = [[], [], []]
    beats: list[list] = [[], [], []]
    past: list[list] = [[], [], []]
    kept: list[list] = [[None, None] for _ in PAIRS]
    doubt = [0.0] * 3

    def forget(p: int) -> None:
        now[p], beats[p], past[p], kept[p], doubt[p] = [], [(None, False)] * 10, [None] * 50, [None, None], 0.0

    for p in range(3):
        forget(p)
    for k in range(ROWS):
        if fresh[k, DOWN]:
            dt = time[k] - spoken
            if 0 < dt <= GAP_S:
                climbed += (-value[k, DOWN] + speed) / 2 * dt
            else:
                forget(1)
                forget(2)
            speed, spoken = -value[k, DOWN], time[k]
        if fresh[k, HEIGHT]:
            if not 0 < time[k] - fixed <= GAP_S:
                for p in range(3):
                    forget(p)
                began = time[k]
            fixed = time[k]
            late = time[k] - spoken
            says = [
                value[k, 0],
                value[k, 1] if fresh[k, BARO] else None,
                climbed + speed * late if late <= GAP_S else None,
            ]
            for p, (i, j) in enumerate(PAIRS):
                if says[i] is not None and says[j] is not None:
                    now[p].append(says[i] - says[j])
            if time[k] - began >= 0.9 * BEAT_S:
                for p in range(3):
                    held = doubt[p] > 0
                    mean = float(np.mean(now[p])) if now[p] else None
                    mean_was, clean = beats[p].pop(0)
                    doubtful = mean_was is not None and not clean
                    past[p] = [*past[p][1:], mean_was if clean else kept[p][1] if doubtful else None]
                    beats[p].append((mean, mean is not None and not held))
                    doubt[p] += (time[k] - began) if held else 0.0
                    now[p] = []
                    before = [mean for mean, clean in beats[p][:-2] if clean]
                    oldest = [mean for mean in past[p][:10] if mean is not None]
                    if len(before) >= 4 and not held:
                        kept[p][0] = float(np.mean(before))
                    if len(oldest) >= 5 and not held:
                        kept[p][1] = float(np.mean(oldest))
                began = time[k]
            for p in range(3):
                for length, many in ((0, 2), (1, 10)):
                    newest = [b[0] for b in beats[p][-many:] if b[0] is not None]
                    if kept[p][length] is not None and len(newest) >= (many + 1) // 2:
                        gaps[k, length, p] = np.mean(newest) - kept[p][length]
        known = np.isfinite(gaps[k, 1, 0]) and fresh[k, BARO]
        healed = known and doubt[0] > 10 * BEAT_S  # nothing is over these limits
        suspicious = doubted.start <= k < doubted.stop
        for p, (i, j) in enumerate(PAIRS):
            if suspicious and any(fresh[k, w] for w in (i, j) if w != DOWN):
                if doubt[p] == 0:
                    beats[p] = [(mean, False) for mean, _ in beats[p]]
                    past[p] = past[p] if DOWN in (i, j) else [kept[p][1]] * 50
                doubt[p] = max(doubt[p], 1e-6)
            elif fresh[k, HEIGHT]:
                if doubt[p] > 10 * BEAT_S and 2 in (i, j):
                    forget(p)
                if doubt[p] > 0:
                    kept[p][0] = None
                doubt[p] = 0.0
        if healed:
            forget(1)
            forget(2)
    return gaps, fresh[:, HEIGHT]


@pytest.mark.parametrize("doubted", [slice(0, 0), slice(300, 312), slice(300, 390)])
def test_gaps(doubted: slice) -> None:
    gap, known, _ = result(doubted)
    gaps, fixes = by_hand(doubted)
    found = np.where(known, gap, np.nan)
    assert np.isfinite(gaps).mean() > 0.2
    np.testing.assert_allclose(found[fixes], gaps[fixes], atol=1e-9)


def test_a_height_is_expected_where_the_other_one_says() -> None:
    time, value, fresh = log()
    *_, expected = result(slice(0, 0))
    rows = np.flatnonzero(fresh[:, HEIGHT] & fresh[:, BARO] & (time > 70) & (time < 120))
    np.testing.assert_allclose(expected[rows, HEIGHT], value[rows, BARO] + 50, atol=0.2)
    np.testing.assert_allclose(expected[rows, BARO], value[rows, HEIGHT] - 50, atol=0.2)


def named_by_hand(over: dict[tuple[int, int], bool], owner: tuple[int, ...]) -> set[int]:
    wrong = [pair for pair, is_over in over.items() if is_over]
    sensors = [s for s in set(owner) if wrong and all(s in {owner[c] for c in pair} for pair in wrong)]
    if len(sensors) != 1:
        return set()
    mine = [c for c, s in enumerate(owner) if s == sensors[0]]
    always = {c for c in mine if all(c in pair for pair in wrong)}
    return always or {c for c in mine if any(c in pair for pair in wrong)}


def test_who_is_named() -> None:
    """All that three and four witnesses may say of each other; the first and the third are of one sensor."""
    for owner in ((0, 1, 0), (0, 1, 0, 2)):
        pairs = tuple(combinations(range(len(owner)), 2))
        covers = jnp.asarray([[c in pair for c in range(len(owner))] for pair in pairs])
        run = jax.jit(named, static_argnums=2)
        for over in product((False, True), repeat=len(pairs)):
            accused = np.asarray(run(jnp.asarray(over), covers, owner))
            expected = named_by_hand(dict(zip(pairs, over, strict=True)), owner)
            assert set(np.flatnonzero(accused).tolist()) == expected, (owner, over)
