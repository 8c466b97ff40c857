"""The laws of a monitor, over every guest and every recipe: see cases/."""

import functools
import json

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import safetensors.numpy

from laws.case import Case
from laws.cases import guests
from laws.compilations import compilations
from laws.damage import absent, alone, half, holed, last_telling, lied, silenced, telling, troubled
from laws.register import CASES, names_with
from laws.walk import Walk, assert_close, assert_same, finite, walk
from sensorfault.core.monitor import SUBJECTS, Monitor
from sensorfault.core.types import Report, Sample
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.runtime.encoding import ModelError, Tensors, decode, encode
from sensorfault.runtime.runners import Stepper, StepResult, fleet
from sensorfault.stages.threshold.fixed import Fixed


def on(*names: str) -> pytest.MarkDecorator:
    """The law for these cases."""
    return pytest.mark.parametrize("case", names, indirect=True)


every_case = on(*CASES)
judging_motion = on(*names_with("moving"))


@functools.lru_cache(maxsize=1)
def healthy(case: Case) -> Walk:
    return walk(case.monitor, case.rows)


@functools.lru_cache(maxsize=1)
def trouble(case: Case) -> Walk:
    return walk(case.monitor, troubled(case))


# Stepper packs state and answer with ravel_pytree, which makes floats of truth values: not strict, and on purpose.
packing = jax.numpy_dtype_promotion("standard")


def push(stream: Stepper, rows: Sample, k: int) -> StepResult:
    """Row k of a log of NumPy arrays."""
    block = jax.tree.map(lambda x: x[k], rows.block)
    return stream.push(rows.time[k], rows.value[k], rows.fresh[k], block if jax.tree.leaves(block) else None)


# 0. What the others rest on: the healthy log is healthy, the lies are named, the masks are what they say.


@every_case
def test_healthy_is_ok_and_a_lie_is_named(case: Case) -> None:
    k, second = telling(case), slice(half(case.rows), None)
    channel, motion = healthy(case).channel[second], healthy(case).motion[second]
    for verdict in (channel, motion):
        assert (verdict == FAULT).mean() < 2 * (case.rate or 0.005)
    assert (channel == OK).any(axis=0)[list(case.accused)].all()
    for c in case.accused:
        result = walk(case.monitor, lied(case.rows, slice(k, k + 1), alone(case, c)))
        assert result.channel[k, c] == FAULT
        assert result.sensor[k, case.monitor.owner[c]] == FAULT
        assert result.sample[k] == FAULT
        assert not result.reports.trust.measured[k, c]


@judging_motion
def test_healthy_motion_is_ok_and_a_lie_about_it_is_its_fault(case: Case) -> None:
    """... and no sensor's: what was measured is taken in as it would be without the verdict."""
    k = telling(case)
    assert (healthy(case).motion[half(case.rows) :] == OK).mean() > 0.5
    for c in case.moving:
        result = walk(case.monitor, lied(case.rows, slice(k, k + 1), alone(case, c)))
        assert result.motion[k] == FAULT
        assert not (result.channel == FAULT).any()
        assert not (result.sample == FAULT).any()
        assert_same(result.reports.trust.measured, healthy(case).reports.trust.measured)


@every_case
def test_masks_are_consistent(case: Case) -> None:
    result, rows = trouble(case), troubled(case)
    trust, fresh = result.reports.trust, np.asarray(rows.fresh) & np.isfinite(rows.value)
    assert not (trust.measured & ~fresh).any()
    assert not (trust.filled & trust.measured).any()
    assert not (trust.learn & ~trust.measured).any()
    assert (result.channel[trust.learn] == OK).all()
    assert not trust.learn[result.sample == FAULT].any()
    assert (result.sensor == sensor_by_sensor(case.monitor.owner, result.channel)).all()
    assert np.isfinite(trust.value).all()


def sensor_by_sensor(owner: tuple[int, ...], channel: np.ndarray) -> np.ndarray:
    return np.stack([channel[:, np.array(owner) == s].max(axis=1) for s in range(max(owner) + 1)], axis=1)


# 1. Stream equals replay.


@every_case
def test_stream_equals_replay(case: Case) -> None:
    """... and is compiled before the first sample comes."""
    result, rows = trouble(case).reports, jax.tree.map(np.asarray, troubled(case))
    with packing:
        stream = Stepper(case.monitor, jax.tree.map(lambda x: x[0], rows.block))
        with compilations() as made:
            answers = [push(stream, rows, k) for k in range(rows.time.size)]
    assert not made
    for k, now in enumerate(answers):
        np.testing.assert_array_equal(now.channel, result.verdict.channel[k])
        np.testing.assert_array_equal(now.sensor, result.verdict.sensor[k])
        assert now.sample == result.verdict.sample[k]
        assert_close(
            (now.score, now.limit, now.value, now.residual, now.silence),
            (
                np.concatenate([np.where(score.valid[k], score.value[k], np.nan) for score in result.scores]),
                np.concatenate([limit[k] for limit in result.limits]),
                result.trust.value[k],
                result.residual.value[k],
                result.silence[k],
            ),
            case.tolerance,
        )


# 2. A distrusted sample leaves references, thresholds and weights as they were.


@every_case
def test_two_lies_leave_the_same_filter_limits_and_weights(case: Case) -> None:
    """Whatever was said, it was not believed: nothing but the evidence may know how big the lie was."""
    k = telling(case)
    for c in case.accused:
        small, big = (walk(case.monitor, lied(case.rows, slice(k, k + 1), n * alone(case, c))) for n in (1, 2))
        assert_same(small.reports.trust.measured[k], big.reports.trust.measured[k])
        for result in (small, big):
            assert not result.reports.trust.learn[k].any()
        after_small, after_big = (jax.tree.map(lambda x: x[k], result.states) for result in (small, big))
        assert_same(after_small.residual, after_big.residual)
        assert_same(case.learned(after_small), case.learned(after_big))


@judging_motion
def test_a_fault_of_the_motion_changes_neither_filter_nor_limits(case: Case) -> None:
    """Two lies leave the same limits and weights, and the filter is what it would be with the verdict silent."""
    k = telling(case)
    silent = with_limit(case.monitor, healthy(case).reports, np.inf)
    for c in case.moving:
        small, big = (lied(case.rows, slice(k, k + 1), n * alone(case, c)) for n in (1, 2))
        after = [walk(case.monitor, rows) for rows in (small, big)]
        for result, rows in zip(after, (small, big), strict=True):
            assert result.motion[k] == FAULT
            assert_same(result.states.residual, walk(silent, rows).states.residual)
        one, two = (case.learned(jax.tree.map(lambda x: x[k], result.states)) for result in after)
        assert_same(one, two)


@every_case
def test_what_may_not_learn_does_not(case: Case) -> None:
    result = trouble(case)
    still = ~result.reports.trust.learn[1:].any(axis=1)
    assert still.any()
    for x in jax.tree.leaves(case.learned(result.states)):
        np.testing.assert_array_equal(x[1:][still], x[:-1][still])


# 3. A limit of +inf is silent, one of -inf alarms wherever there is a valid test.


def with_limit(monitor: Monitor, report: Report, limit: float) -> Monitor:
    fixed = [Fixed(jnp.full(limits.shape[1:], limit, float)) for limits in report.limits]
    return eqx.tree_at(lambda m: [branch.threshold for branch in m.branches], monitor, fixed)


@every_case
def test_infinite_limits(case: Case) -> None:
    reports = trouble(case).reports
    silent = walk(with_limit(case.monitor, reports, np.inf), troubled(case))
    assert not (silent.channel == FAULT).any()
    assert not (silent.sample == FAULT).any()
    assert not (silent.reports.verdict.motion == FAULT).any()
    loud = walk(with_limit(case.monitor, reports, -np.inf), troubled(case))
    scores = zip(case.monitor.branches, loud.reports.scores, strict=True)
    tested = {subject: np.zeros(len(loud.sample), bool) for subject in SUBJECTS}
    for branch, score in scores:
        tested[branch.subject] |= score.valid.any(axis=1)
    assert any(rows.any() for rows in tested.values())
    assert (loud.sample[tested["sensor"]] == FAULT).all()
    assert (loud.sensor[tested["sensor"]] == FAULT).any(axis=1).all()
    if not tested["sensor"].any():  # with a sensor at fault nothing is said of the motion
        assert (loud.reports.verdict.motion[tested["motion"]] == FAULT).all()


# 4. What is not there is unknown, poisons nothing, and does not silence the others.


@every_case
@pytest.mark.parametrize("remove", [silenced, absent])
def test_a_missing_channel_is_unknown_and_the_others_are_judged(case: Case, remove) -> None:
    start, length = half(case.rows) + 7, 40
    gone = slice(start, start + length)
    clean, time = healthy(case), np.asarray(case.rows.time)
    for c in range(case.channels):
        result = walk(case.monitor, remove(case.rows, gone, c))
        assert finite(result.states)
        fresh = np.flatnonzero(np.asarray(case.rows.fresh)[:start, c])
        late = time[gone] - time[fresh[-1]] > case.hold_s[c] + 1e-9
        assert late.any()
        assert (result.channel[gone, c][late] == UNKNOWN).all()
        assert (result.sensor[gone, case.monitor.owner[c]][late] >= UNKNOWN).all()
        others = ~np.isin(np.arange(case.channels), (c, *case.lost.get(c, ())))
        assert (result.channel[gone][:, others] != UNKNOWN)[clean.channel[gone][:, others] != UNKNOWN].all()


@every_case
def test_an_empty_sample_is_unknown(case: Case) -> None:
    k = half(case.rows) + 7
    long = slice(k, k + 40)
    result = walk(case.monitor, silenced(case.rows, long))
    assert finite(result.states)
    late = np.asarray(case.rows.time)[long] - np.asarray(case.rows.time)[k - 1] > case.hold_s.max() + 1e-9
    assert late.any()
    assert (result.channel[long][late] == UNKNOWN).all()
    assert (result.sample[long][late] == UNKNOWN).all()
    assert (result.motion[long][late] == UNKNOWN).all()


@on(*names_with("block"))
def test_a_hole_in_the_block_costs_one_sample(case: Case) -> None:
    k = telling(case)
    result, clean = walk(case.monitor, holed(case.rows, k)), healthy(case)
    assert finite(result.states)
    assert not (result.channel[k] == FAULT).any()
    after = slice(k + 1, None)
    assert (result.channel[after] == clean.channel[after]).mean() > 0.99


# 5. Channels have no order, vehicles have no neighbours.


@on(*names_with("permuted"))
def test_permuted_channels_permute_the_verdicts(case: Case) -> None:
    assert case.permuted
    order = np.roll(np.arange(case.channels), 1)
    rows, result = troubled(case), trouble(case)
    other = walk(
        case.permuted(order),
        rows._replace(value=rows.value[:, order], present=rows.present[:, order], fresh=rows.fresh[:, order]),
    )
    np.testing.assert_array_equal(other.channel, result.channel[:, order])
    np.testing.assert_array_equal(other.sample, result.sample)
    assert_close(other.reports.residual.value, result.reports.residual.value[:, order], 1e-8)


@every_case
def test_a_fleet_is_its_vehicles(case: Case) -> None:
    assert_fleet(case, 3)


@on("pairs")
def test_a_fleet_of_one_is_one(case: Case) -> None:
    assert_fleet(case, 1)


def assert_fleet(case: Case, vehicles: int) -> None:
    logs = [troubled(case), case.rows, lied(case.rows, slice(half(case.rows), None), alone(case, 0))][:vehicles]

    @jax.jit
    def together(monitor, states, rows):
        return fleet(monitor, states, rows, lambda r: (r.verdict, r.residual.value, r.trust.value))

    def stack(trees):
        return jax.tree.map(lambda *x: np.stack(x), *trees)

    state = case.monitor.init()
    states, result = together(case.monitor, stack([state] * vehicles), stack(logs))
    for i, log in enumerate(logs):
        single = walk(case.monitor, log)
        mine = jax.tree.map(lambda x, i=i: np.asarray(x[i]), result)
        expected = single.reports.verdict, single.reports.residual.value, single.reports.trust.value
        assert_close(mine, expected, case.tolerance)
        end = jax.tree.map(lambda x, i=i: np.asarray(x[i]), states)
        # a window's moments are sums of cubes that cancel: what rounding leaves is larger there than in the report
        assert_close(end, jax.tree.map(lambda x: x[-1], single.states), max(1e-8, case.tolerance))


# 6. Saved and loaded: the same to the bit.


@every_case
def test_saved_and_loaded_it_says_the_same(case: Case, guests_known: None) -> None:
    """Through the bytes of a model file: see test_store.py for what else stands in one."""
    tensors: Tensors = {}
    header = json.dumps(encode(case.monitor, "monitor", tensors))
    back = decode(json.loads(header), safetensors.numpy.load(safetensors.numpy.save(tensors)))
    assert_same(back, case.monitor)
    for one, two in zip(jax.tree.leaves(back), jax.tree.leaves(case.monitor), strict=True):
        assert one.dtype == two.dtype
    assert_same(walk(back, troubled(case)), trouble(case))


@on(*guests.CASES)
def test_what_load_would_not_know_is_not_saved(case: Case) -> None:
    """Toy parts stand in no room of the package."""
    with pytest.raises(
        ModelError, match=r"^monitor[\w.]*: 'load' would not know the class \w+, so it cannot be saved; "
    ):
        encode(case.monitor, "monitor", {})


# 7. One compilation a shape.


@every_case
def test_one_compilation_a_shape(case: Case) -> None:
    """Neither another log nor other numbers in the monitor compile the replay again."""
    rows = troubled(case)
    shifted = jax.tree.map(lambda x: x * 1.5 if eqx.is_inexact_array_like(x) else x, case.monitor)
    start = case.monitor.init()
    healthy(case)
    with compilations() as made:
        walk(shifted, rows, start)
    assert not made


def test_compilations_are_counted() -> None:
    with compilations() as made:
        jax.jit(lambda x: x + 1)(np.ones(3))
    assert made


# 8. It comes back.


def assert_back(case: Case, result: Walk, end: int, rows: Sample | None = None) -> None:
    """From `back_s` after row `end`, the verdicts are those of the healthy run."""
    time = np.asarray((rows or case.rows).time)
    back = time > time[end] + case.back_s
    assert back.sum() >= 20, "the log ends too early to tell"
    assert (result.channel[back] == healthy(case).channel[back]).mean() > 0.99
    assert (result.channel[back] == OK).any(axis=0)[list(case.accused)].all()
    if case.moving:
        assert (result.motion[back] == healthy(case).motion[back]).mean() > 0.99
        assert (result.motion[back] == OK).any()


@every_case
def test_back_after_a_dropout(case: Case) -> None:
    start = half(case.rows)
    assert_back(case, walk(case.monitor, silenced(case.rows, slice(start, start + 50))), start + 50)


@every_case
def test_back_after_a_gap_in_the_clock(case: Case) -> None:
    start = half(case.rows)
    later = np.where(np.arange(case.rows.time.size) < start, 0.0, 60.0)
    rows = case.rows._replace(time=np.asarray(case.rows.time) + later)
    assert_back(case, walk(case.monitor, rows), start, rows)


@every_case
def test_back_after_a_long_fault(case: Case) -> None:
    """... and as watchful as before: the same lie told again is named again."""
    start, again = telling(case), last_telling(case)
    for c in (*case.accused, *case.moving):
        lie = alone(case, c)
        long = slice(start, start + 75)
        rows = lied(case.rows, long, lie)
        result = walk(case.monitor, lied(rows, slice(again, again + 1), lie))
        for k in (start, again):
            assert (result.motion[k] if c in case.moving else result.channel[k, c]) == FAULT
        assert_back(case, walk(case.monitor, rows), start + 75)


# 9. False alarms come as often as designed.


@on(*names_with("rate"))
def test_false_alarms_come_at_the_designed_rate(case: Case) -> None:
    assert case.rate
    assert case.quiet
    vehicles, long = case.quiet.time.shape
    states = jax.tree.map(lambda x: np.broadcast_to(x, (vehicles, *x.shape)), case.monitor.init())
    _, channel = jax.jit(lambda m, s, r: fleet(m, s, r, lambda report: report.verdict.channel))(
        case.monitor, states, case.quiet
    )
    warm = np.asarray(channel)[:, long // 2 :].reshape(-1, case.channels)
    achieved = (warm == FAULT).sum(axis=0) / (warm != UNKNOWN).sum(axis=0)
    assert (achieved > case.rate / 2).all()
    assert (achieved < case.rate * 2).all()
