"""The observer of a height against plain loops: lists for the ring, one height after the other."""

from dataclasses import replace
from itertools import pairwise

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import flown
from laws.walk import walk
from sensorfault.core.types import Trust
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.methods.height import kinematic_observer
from sensorfault.runtime.runners import samples
from sensorfault.training.session import SILENT
from sensorfault.vehicles.height import Climb, StepNetwork

STEPS = (1, 5, 12)


def drawn(sets: int, seed: int = 0) -> StepNetwork:
    random = np.random.default_rng(seed)
    parts = [random.normal(size=shape) for shape in ((sets, 10, 3), (sets, 10), (sets, 10), (sets,))]
    center, half = np.array([300.0, 0.0, 0.1]), np.array([40.0, 3.0, 0.2])
    numbers = [jnp.asarray(x) for x in (*parts, center, half, 0.3, 0.2)]
    return StepNetwork(*numbers, columns=(1, 3))


def past(rows: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights of so many fixes, inputs and times with one more."""
    random = np.random.default_rng(seed)
    time = np.cumsum(random.uniform(0.15, 0.3, rows + 1))
    return 300 + random.normal(size=rows), random.normal(size=(rows + 1, 2)), time


def by_hand(net: StepNetwork, height, inputs, time, n: int) -> float:
    w, b, v, c = (np.asarray(x) for x in (net.weights, net.bias, net.output, net.offset))
    center, half = np.asarray(net.center), np.asarray(net.half)
    start = len(height) - n
    h = height[start]
    for j in range(n):
        i = start + j
        x = np.clip((np.array([h, *inputs[i]]) - center) / half, -2, 2)
        own = min(j, len(c) - 1)
        hidden = [max(0.0, sum(w[own, u, k] * x[k] for k in range(3)) + b[own, u]) for u in range(10)]
        gain = sum(v[own, u] * hidden[u] for u in range(10)) + c[own]
        h = h + gain * 0.3 * (time[i + 1] - time[i]) / 0.2
    return float(h)


@pytest.mark.parametrize("sets", [1, 4])
def test_a_network_feeds_back_what_it_foretold(sets: int) -> None:
    net, (height, inputs, time) = drawn(sets), past(9)
    got = net.rolled(*(jnp.asarray(x) for x in (height, inputs, time)), jnp.asarray([1, 4, 9]))
    np.testing.assert_allclose(got, [by_hand(net, height, inputs, time, n) for n in (1, 4, 9)], rtol=1e-12)


def test_a_climb_is_added_up() -> None:
    height, inputs, time = past(9)
    x, steps = inputs[:, :1], (1, 4, 9)
    for climb, gained in (
        (Climb(jnp.asarray(-1.0), (1,)), lambda i: -(x[i, 0] + x[i + 1, 0]) / 2 * (time[i + 1] - time[i])),
        (Climb(jnp.asarray(1.0), (2,), speed=False), lambda i: x[i + 1, 0] - x[i, 0]),
    ):
        got = climb.rolled(*(jnp.asarray(part) for part in (height, x, time)), jnp.asarray(steps))
        want = [height[9 - n] + sum(gained(i) for i in range(9 - n, 9)) for n in steps]
        np.testing.assert_allclose(got, want, rtol=1e-12)


class Textbook:
    """The kinematic observer with all that may happen to it, on a clock on which every row is a height."""

    def __init__(self, limits, horizon_s: float, readmit_s: float, gap_s: float) -> None:
        self.limits, self.horizon, self.readmit, self.gap = limits, horizon_s, readmit_s, gap_s
        self.past: list[tuple[float, float, float]] = []
        self.healthy = self.accused = self.origin = -1e12

    def roll(self, n: int, t: float, down: float) -> float:
        rows = [(a, x) for a, _, x in self.past[-n:]] + [(t, down)]
        climbed = sum(-(x + y) / 2 * (b - a) for (a, x), (b, y) in pairwise(rows))
        return self.past[-n][1] + climbed

    def push(self, t: float, h: float, down: float) -> tuple[int, float, float]:
        """Verdict, what is expected, and the time of the height that was rolled out."""
        if self.past and t - self.past[-1][0] > self.gap:
            self.past = []
        known, there = np.isfinite(down), np.isfinite(h)
        ready = [n for n in STEPS if known and len(self.past) >= n]
        rolled = {n: self.roll(n, t, down) for n in ready}
        alone = bool(self.past) and self.origin < self.past[-1][0]
        expected = h
        origin = self.origin
        if ready:
            longest = max(ready)
            expected = self.roll(1, t, down) if alone else rolled[longest]
            origin = self.origin if alone else self.past[-longest][0]
        tested = there and bool(ready)
        over = tested and any(abs(h - rolled[n]) > self.limits[n] for n in ready)
        if over:
            self.accused = t
        doubted = t - self.accused <= self.readmit
        measured = there and not doubted
        filled = there and doubted and t - self.healthy <= self.horizon and bool(ready)
        if there:
            if (measured or filled) and known:
                self.past.append((t, h if measured else expected, down))
            else:
                self.past = []
            self.origin = t if measured else origin
        if measured:
            self.healthy = t
        return FAULT if over else OK if tested else UNKNOWN, expected, origin


def test_the_observer_and_its_verdicts() -> None:
    log = flown.flight()
    setting = kinematic_observer.Setting((0.2, 1.0, 2.4), horizon_s=3.0)
    monitor = kinematic_observer.build(log.between(end_s=160.0), 0, SILENT, setting).monitor
    part = log.between(160.0)
    value = part.value.copy()
    value[60:90, flown.HEIGHT] += 0.15 * np.arange(30)  # drifts, longer than anything stands in
    value[140, flown.HEIGHT] += 5.0
    value[180:190, flown.HEIGHT] = np.nan
    value[220:222, flown.DOWN] = np.nan
    value[260:263, flown.HEIGHT] += 5.0
    value[262, flown.DOWN] = np.nan  # doubted, and nothing to go on with
    result = walk(monitor, samples(part.time, value, np.isfinite(value)))
    limits = dict(zip(STEPS, np.asarray(monitor.branches[0].threshold.limit).tolist(), strict=True))
    recovery = monitor.recovery
    book = Textbook(limits, 3.0, float(recovery.readmit_s), float(monitor.residual.gap_s))
    rows = zip(part.time.tolist(), value[:, flown.HEIGHT].tolist(), value[:, flown.DOWN].tolist(), strict=True)
    verdict, expected, origin = (np.array(x) for x in zip(*(book.push(*row) for row in rows), strict=True))
    np.testing.assert_array_equal(result.channel[:, flown.HEIGHT], verdict)
    assert {*verdict[60:140].tolist()} == {OK, UNKNOWN, FAULT}
    there = np.isfinite(expected)
    np.testing.assert_allclose(result.reports.residual.expected[there, flown.HEIGHT], expected[there], rtol=1e-10)
    told_cov = result.reports.residual.cov[:, flown.HEIGHT, flown.HEIGHT]
    tested = verdict != UNKNOWN
    ages, variance = np.asarray(monitor.residual.ages), np.asarray(monitor.residual.variance)
    age = (part.time - origin)[tested]
    want = np.interp(age, ages, variance) * np.maximum(age / ages[-1], 1) ** 2
    np.testing.assert_allclose(told_cov[tested], want, rtol=1e-9)


def test_a_height_that_was_not_trusted_starts_nothing() -> None:
    """What comes of a drift is measured from before it, as long as anything stands in; the error grows meanwhile."""
    log = flown.flight()
    setting = kinematic_observer.Setting((1.0, 2.4), horizon_s=10.0)
    monitor = kinematic_observer.build(log.between(end_s=160.0), 0, SILENT, setting).monitor
    part = log.between(160.0)
    value = part.value.copy()
    value[100:140, flown.HEIGHT] += 0.2 * np.arange(40)
    result = walk(monitor, samples(part.time, value, np.isfinite(value)))
    first = 100 + int(np.argmax(result.channel[100:140, flown.HEIGHT] == FAULT))
    assert first < 115
    assert (result.channel[first:140, flown.HEIGHT] == FAULT).all()
    stands_in = result.reports.trust.value[first:140, flown.HEIGHT]
    assert np.abs(stands_in - part.value[first:140, flown.HEIGHT]).max() < 1.0
    spread = result.reports.residual.cov[first:140, flown.HEIGHT, flown.HEIGHT]
    assert (np.diff(spread) >= 0).all()
    assert spread[-1] > 1.1 * spread[0]


def test_nothing_stands_in_where_nothing_is_foretold() -> None:
    """A height that is kept out before there is a past begins none, though the monitor would fill it in."""
    log = flown.flight()
    part = kinematic_observer.build(log, 0, SILENT, kinematic_observer.Setting((1.0,))).monitor.residual
    row = jax.tree.map(lambda x: x[0], samples(log.time[:1], log.value[:1], log.fresh[:1]))
    for measured in (False, True):
        _, pending = part.evaluate(part.init(), row)
        believed = jnp.asarray(np.arange(5) != flown.HEIGHT) | measured
        state = part.update(pending, Trust(row.value, believed, ~believed, believed, row.born))
        assert int(state.whole) == int(measured)


def test_no_past_goes_over_a_gap() -> None:
    log = flown.flight()
    monitor = kinematic_observer.build(log, 0, SILENT, kinematic_observer.Setting((1.0,))).monitor
    part = log.between(end_s=20.0)
    later = replace(part, time=part.time + np.where(np.arange(100) < 50, 0.0, 5.0))
    result = walk(monitor, samples(later.time, later.value, later.fresh))
    verdict = result.channel[:, flown.HEIGHT]
    assert (verdict[:5] == UNKNOWN).all()
    assert (verdict[5:50] == OK).all()
    assert (verdict[50:55] == UNKNOWN).all()
    assert (verdict[55:] == OK).all()
