"""The cubature filter as a residual: what it predicts, what it takes in, and how it comes back."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

import missions
from laws.walk import walk
from sensorfault.core.monitor import Branch
from sensorfault.core.verdicts import FAULT
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.methods.ranging.range_filter import Filter, cubature, followed, monitor, on_ranges
from sensorfault.stages.residual.measurement_noise import Stated
from sensorfault.stages.statistic.normalised import Normalised

R = jnp.asarray([9.0, 4.0])


def through(log, filter=Filter(q=0.1), limit=np.inf):  # noqa: B008
    found = followed("test", log)
    branch = Branch(Normalised(), on_ranges(log, found, limit))
    return walk(monitor(log, cubature(log, found, filter), branch), missions.rows(log))


def off_m(result, mission) -> np.ndarray:
    """How far the belief is from the truth at each tick [m]."""
    scale = np.array([6.367e6, 6.387e6 * np.cos(mission.truth.value[0, 0])])
    return np.linalg.norm((result.states.residual.mean - mission.truth.value[:, :2]) * scale, axis=1)


def test_innovations_are_as_large_as_it_says() -> None:
    result = through(missions.healthy().log, Filter(q=0.1, adaptive=False))
    for column in missions.RANGES:
        valid = result.reports.residual.valid[:, column]
        size = result.reports.residual.value[valid, column] / np.sqrt(
            result.reports.residual.cov[valid, column, column]
        )
        assert valid.sum() > 150
        assert 0.85 < size.std() < 1.15


def test_it_knows_where_it_is() -> None:
    mission = missions.healthy()
    result = through(mission.log)
    assert np.percentile(off_m(result, mission)[60:], 95) < 5.0


def test_a_surprise_weighs_less() -> None:
    """(30), (31): R* = R max(1, r² / P_zz), each range by itself."""
    log = inject(missions.healthy().log, [Fault("offset", "leader1", "range", 500.0, 30.0, 40.0)]).log
    residual = through(log).reports.residual
    column = missions.RANGES[0]
    valid = residual.valid[:, column]
    want = 9.0 * np.maximum(1, residual.value[:, column] ** 2 / residual.cov[:, column, column])
    np.testing.assert_allclose(residual.noise[valid, column], want[valid], rtol=1e-3)
    assert residual.noise[valid, column].max() > 50


def test_an_exact_repeat_is_no_news() -> None:
    mission = missions.healthy()
    log = inject(mission.log, [Fault("frozen", "leader1", "range", 500.0, 120.0)]).log
    fooled, wise = (off_m(through(log, Filter(q=0.1, repeated=times)), mission) for times in (1.0, 1e6))
    alone = off_m(through(mission.log), mission)
    during = slice(500, 640)
    assert fooled[during].max() > alone[during].max() + 3.0
    assert wise[during].max() < alone[during].max() + 2.0


def test_refusing_all_it_doubts_itself() -> None:
    """Put 80 m off, a filter whose gate is shut comes back if its doubt grows, and not in minutes if it does not."""
    mission = missions.healthy()
    log = mission.log
    value = log.value.copy()
    value[0, :2] += 80 / 6.367e6, 80 / 4.45e6
    moved = replace(log, value=value)
    stays, returns = (off_m(through(moved, Filter(q=0.1, growth=g), 2.6), mission) for g in (0.0, 0.5))
    assert returns[150:].max() < 15.0
    assert stays[150] > 30.0


def test_without_a_heading_the_way_is_unknown() -> None:
    """Two metres a second in a direction that nobody knows: the spread grows in proportion to the time."""
    log = missions.healthy().log
    value, fresh = log.value.copy(), log.fresh.copy()
    hidden = (slice(300, 400), [4, 6, 7, 8, 9, 10, 11, 12, 13])
    value[hidden], fresh[hidden] = np.nan, False
    result = through(replace(log, value=value, fresh=fresh))
    spread = 6.367e6 * np.sqrt((result.states.residual.root[:, 0] ** 2).sum(axis=1))
    assert spread[399] == pytest.approx(spread[301] + 2.0 * 98, rel=0.02)
    assert off_m(result, missions.healthy())[440:].max() < 25.0


def test_nothing_is_told_before_a_first_fix() -> None:
    log = missions.healthy().log
    value, fresh = log.value.copy(), log.fresh.copy()
    value[:200, :2], fresh[:200, :2] = np.nan, False
    result = through(replace(log, value=value, fresh=fresh), limit=0.0)
    assert not result.reports.residual.valid[:200].any()
    assert not (result.channel[:200] == FAULT).any()
    assert result.reports.residual.valid[201:, missions.RANGES[0]].any()


def test_what_surprises_is_believed_less_at_once() -> None:
    """R* = R / η, each measurement by itself; without `inflated` R stays as stated."""
    innovation, predicted = jnp.asarray([10.0, 1.0]), jnp.asarray([1.0, 1.0])
    np.testing.assert_array_equal(Stated().in_use(R, innovation, predicted), R)
    np.testing.assert_allclose(Stated(inflated=True).in_use(R, innovation, predicted), [9.0 * 100.0 / 10.0, 4.0])
