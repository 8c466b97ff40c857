"""The runners' edges: rows from a log, one sample at a time, many vehicles at once."""

import os
import subprocess
import sys

import jax
import numpy as np
import pytest

from laws.guests.zoo import ROWS, block, three_positions
from sensorfault.core.verdicts import OK, UNKNOWN
from sensorfault.runtime.runners import Stepper, everything, fleet, replay, samples


@pytest.fixture(scope="module")
def stepper() -> Stepper:
    return Stepper(three_positions())


def test_nan_in_a_log_is_absent_and_never_fresh() -> None:
    rows = samples(np.arange(2.0), np.array([[1.0, np.nan], [np.inf, 2.0]]), np.ones((2, 2), bool))
    np.testing.assert_array_equal(rows.present, [[True, False], [False, True]])
    np.testing.assert_array_equal(rows.fresh, rows.present)
    assert not rows.born.any()


def test_replay_keeps_what_it_is_told_to() -> None:
    monitor, rows = three_positions(), samples(0.02 * np.arange(3), np.ones((3, 3)), np.ones((3, 3), bool))
    _, report = replay(monitor, monitor.init(), rows)
    assert report.verdict.channel.shape == (3, 3)
    assert report.residual.cov.shape == (3, 3, 3)
    _, sample = replay(monitor, monitor.init(), rows, lambda report: report.verdict.sample)
    np.testing.assert_array_equal(sample, [OK, OK, OK])
    assert everything(report) is report


def test_a_fleet_has_a_leading_axis_everywhere() -> None:
    monitor, rows = three_positions(), samples(0.02 * np.arange(3), np.ones((3, 3)), np.ones((3, 3), bool))
    two = jax.tree.map(lambda x: np.stack([x, x]), (monitor.init(), rows))
    states, verdict = fleet(monitor, *two, lambda report: report.verdict)
    assert verdict.channel.shape == (2, 3, 3)
    assert states.seen.shape == (2, 3)


def test_the_cpu_computes_what_was_put_nowhere_and_a_choice_made_before_counts() -> None:
    """Also where there is a GPU: a single log takes it twelve to thirty times as long."""
    tell = "import sensorfault.core._jax, jax; print(jax.config.jax_default_device)"
    result = {}
    for chosen in ("", "cpu"):
        env = {name: value for name, value in os.environ.items() if name != "JAX_PLATFORMS"} | {"JAX_PLATFORMS": chosen}
        result[chosen] = subprocess.run(
            [sys.executable, "-c", tell], env=env, capture_output=True, text=True, check=True
        )
    assert [one.stdout.strip() for one in result.values()] == ["cpu", "None"]


def test_a_step_answers_with_plain_numbers(stepper: Stepper) -> None:
    now = stepper.push(0.0, [1.0, 1.0, np.nan])
    np.testing.assert_array_equal(now.channel, [OK, OK, UNKNOWN])
    assert isinstance(now.sample, int)
    assert now.channel.dtype == np.int8
    assert (now.score.shape, now.limit.shape, now.value.shape) == ((3,), (3,), (3,))
    np.testing.assert_array_equal(np.isnan(now.score), [False, False, True])
    np.testing.assert_array_equal(now.valid, [True, True, False])


def test_a_step_takes_freshness_for_one_or_for_all(stepper: Stepper) -> None:
    for fresh, tested in ((False, 0), (True, 3), ([True, False, True], 2)):
        now = stepper.push(1.0, [1.0, 1.0, 1.0], fresh)
        assert now.valid.sum() == tested


def test_two_steppers_of_one_monitor_do_not_share_their_state(stepper: Stepper) -> None:
    other = Stepper(three_positions())
    stepper.push(2.0, [5.0, 5.0, 5.0])
    one, two = (each.push(2.02, [5.0, 5.0, 5.0]) for each in (stepper, other))
    assert not np.array_equal(one.residual, two.residual)


def test_a_block_goes_in_with_its_sample() -> None:
    case = block()
    rows = jax.tree.map(np.asarray, case.rows)
    stepper = Stepper(case.monitor, jax.tree.map(lambda x: x[0], rows.block))
    quiet, pushed = (rows.block._replace(acceleration=np.full_like(rows.block.acceleration, a)) for a in (0.0, 50.0))
    for k, motion in ((0, quiet), (1, quiet)):
        now = stepper.push(rows.time[k], rows.value[k], True, jax.tree.map(lambda x, k=k: x[k], motion))
    quietly = now.residual
    again = Stepper(case.monitor, jax.tree.map(lambda x: x[0], rows.block))
    for k, motion in ((0, quiet), (1, pushed)):
        now = again.push(rows.time[k], rows.value[k], True, jax.tree.map(lambda x, k=k: x[k], motion))
    # speed expected grows by acceleration times the rows' time
    np.testing.assert_allclose(quietly[1] - now.residual[1], 50.0 * ROWS * case.monitor.residual.row_s, rtol=1e-9)
