"""Several residuals as one: each part as if it were alone."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

from laws.guests.filters import ConstantVelocity
from laws.guests.statistics import Normalized
from laws.guests.zoo import R3, log, position_log
from laws.walk import assert_close, finite, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Sample
from sensorfault.core.verdicts import FAULT
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.threshold.fixed import Fixed

CHANNELS = 3


def kalman(q: float) -> ConstantVelocity:
    h = jnp.asarray([[1.0, 0.0]] * CHANNELS)
    return ConstantVelocity(h, jnp.asarray(R3), jnp.asarray(q), jnp.asarray([100.0, 30.0]))


def monitor(residual, *statistics, limit: float = 6.0, most: int = 1) -> Monitor:
    branches = tuple(Branch(one, Fixed(jnp.full(CHANNELS, limit))) for one in statistics)
    return Monitor(residual, branches, Exceed(), Drop(), jnp.zeros(CHANNELS), (0, 1, 2), most)


def two(answers) -> Several:
    return Several((kalman(0.5), kalman(50.0)), jnp.asarray(answers))


@pytest.fixture(scope="module")
def rows() -> Sample:
    value = position_log(8, 120)
    value[80:90, 1] += 25.0
    return log(value)


@pytest.mark.parametrize("alone", [0, 1])
def test_each_part_is_as_if_alone(rows: Sample, alone: int) -> None:
    answers = np.zeros((2, CHANNELS), bool)
    answers[alone] = True
    together = walk(monitor(two(answers), SelectResidual(Normalized(), alone)), rows)
    single = walk(monitor(two(answers).parts[alone], Normalized()), rows)
    assert (together.channel[80:90, 1] == FAULT).any()
    assert_close(together.reports.verdict, single.reports.verdict)
    for name in ("value", "cov", "expected", "noise", "valid"):
        assert_close(getattr(together.reports.residual, name), getattr(single.reports.residual, name))


def test_each_channel_is_answered_for_by_its_part(rows: Sample) -> None:
    result = walk(
        monitor(two([[True, False, False], [False, True, False]]), SelectResidual(Normalized(), 0)), rows
    ).reports.residual
    calm, quick = result.extra
    np.testing.assert_array_equal(
        result.value, np.stack([calm.value[:, 0], quick.value[:, 1], 0 * calm.value[:, 2]], 1)
    )
    np.testing.assert_array_equal(
        result.valid, np.stack([calm.valid[:, 0], quick.valid[:, 1], calm.valid[:, 2] & False], 1)
    )
    assert (result.cov[:, 0, 1] == 0).all()
    np.testing.assert_array_equal(result.cov[:, 1, 1], quick.cov[:, 1, 1])


def test_what_is_taken_out_is_out_of_every_part(rows: Sample) -> None:
    """The second part's test is judged again without the channel that the first accused."""
    both = monitor(two([[True] * 3, [False] * 3]), SelectResidual(Normalized(), 0), SelectResidual(Normalized(), 1))
    result = walk(both, rows)
    assert (result.channel[80:90, [0, 2]] != FAULT).all()
    assert (result.channel[80, 1] == FAULT).all()


def test_a_part_that_is_lost_does_not_take_the_others_along(rows: Sample) -> None:
    whole = two([[True] * 3, [False] * 3])
    lost = eqx.tree_at(lambda residual: residual.parts[1].r, whole, jnp.full(CHANNELS, jnp.nan))
    result = walk(monitor(lost, SelectResidual(Normalized(), 0)), rows)
    single = walk(monitor(whole.parts[0], Normalized()), rows)
    assert_close(result.reports.verdict, single.reports.verdict)
    assert finite(result.states)
