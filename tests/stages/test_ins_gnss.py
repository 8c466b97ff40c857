"""How the GNSS/INS filter takes what happens to it: clocks that jump, tunnels, holes, refusals, running away."""

from dataclasses import replace
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from laws.walk import Walk, finite, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.logs.epochs import Framing, framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, monitor, navigation
from sensorfault.numerics.alignment import ALIGNED, MOVING
from sensorfault.runtime.runners import samples
from sensorfault.simulation.ride import Ride
from sensorfault.simulation.train import ride
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed

LIMIT = 6.0
AT, SATELLITE = 60, 3  # an epoch under way, and who lies


@cache
def train() -> Ride:
    """Ten satellites, under way from the fortieth second on."""
    return ride(100.0, seed=1, noise="gaussian", imu_hz=10)


@cache
def how() -> Framing:
    return framing(train().log, train().sky.names, False)


@cache
def epochs() -> Log:
    return how().frame(train().log)


@cache
def judge(bank: bool = False) -> Monitor:
    limit = Branch(Normalised(), Fixed(LIMIT * jnp.ones(len(how().channels))))
    return monitor(how(), navigation(how(), Filter(bank=bank)), limit)


def result(log: Log, bank: bool = False) -> Walk:
    return walk(judge(bank), samples(log.time, log.value, log.fresh, log.block))


def off(run: Walk) -> np.ndarray:
    """Of the true position [m], of as many epochs as the log has."""
    truth = train().position[np.searchsorted(train().log.time, epochs().time - 1e-6)]
    return np.linalg.norm(run.states.residual.nav.position - truth, axis=1)


def without(span: slice, satellites: slice = slice(None)) -> Log:
    value = epochs().value.copy()
    value[span, satellites] = np.nan
    return replace(epochs(), value=value, fresh=epochs().fresh & np.isfinite(value))


def blind(span: slice) -> Log:
    block = epochs().block
    ok, gyro = block.ok.copy(), block.gyro.copy()
    ok[span], gyro[span] = False, 0.0
    return replace(epochs(), block=block._replace(ok=ok, gyro=gyro))


def lying(by: float, span: slice, satellites: slice | int = SATELLITE) -> Log:
    value = epochs().value.copy()
    value[span, satellites] += by
    return replace(epochs(), value=value)


def test_from_nothing_to_navigating() -> None:
    run = result(epochs())
    phase = run.states.residual.phase
    assert (np.diff(phase) >= 0).all()
    assert phase[2] == MOVING
    assert phase[AT] == ALIGNED
    assert not (run.channel == FAULT).any()
    assert (run.channel[phase >= MOVING][1:] == OK).mean() > 0.95
    assert off(run)[phase == ALIGNED].max() < 6.0


@pytest.mark.parametrize("bank", [False, True])
def test_a_jump_of_the_clock_accuses_nobody(bank: bool) -> None:
    jump = 299792.458
    run, calm = result(lying(jump, slice(AT, None), slice(None)), bank), result(epochs(), bank)
    assert not (run.channel == FAULT).any()
    assert run.channel[AT, SATELLITE] == OK
    clock = run.states.residual.own.clock - calm.states.residual.own.clock
    assert abs(clock[AT] - jump) < 5.0
    assert abs(clock[-1] - jump) < 1.0
    assert np.abs(off(run) - off(calm)).max() < 3.0


def test_through_a_tunnel_by_itself() -> None:
    run = result(without(slice(AT, AT + 15)))
    assert (run.channel[AT : AT + 15] == UNKNOWN).all()
    assert off(run)[AT + 14] < 60.0
    assert not (run.channel == FAULT).any()
    assert off(run)[AT + 20 :].max() < 6.0


def test_wheels_hold_it_in_a_tunnel() -> None:
    speed = np.linalg.norm(train().velocity, axis=1)[np.searchsorted(train().log.time, epochs().time - 1e-6)]
    silent = without(slice(AT, AT + 15))
    run = result(replace(silent, block=silent.block._replace(ahead=speed)))
    assert off(run)[AT + 14] < 0.5 * off(result(silent))[AT + 14]
    assert not (run.channel == FAULT).any()


def test_satellites_come_and_go() -> None:
    run = result(without(slice(AT, AT + 10), slice(0, 6)))
    assert (run.channel[AT : AT + 10, :6] == UNKNOWN).all()
    assert (run.channel[AT : AT + 10, 6:] == OK).all()
    assert (run.channel[AT + 10 :] == OK).all()
    claimed = np.sqrt(np.einsum("tii->t", run.states.residual.cov[:, 6:9, 6:9]))
    assert (off(run)[AT:] < 3 * claimed[AT:]).all()
    assert claimed[AT + 9] > 2 * claimed[AT - 1]


def test_a_hole_in_the_inertial_rows_costs_doubt_alone() -> None:
    run, calm = result(blind(slice(AT, AT + 1))), result(epochs())
    assert finite(run.states)
    assert not (run.channel == FAULT).any()
    wide, usual = (np.einsum("tii->t", r.states.residual.cov[:, 3:6, 3:6]) for r in (run, calm))
    assert (run.channel[AT] == OK).all()
    assert wide[AT] > usual[AT]
    assert (run.states.residual.phase[AT:] == ALIGNED).all()


def test_without_any_inertial_row_it_follows_position_and_velocity() -> None:
    run = result(blind(slice(None)))
    assert (run.states.residual.phase[5:] == MOVING).all()
    assert not (run.channel == FAULT).any()
    assert np.median(off(run)[20:]) < 6.0


def test_who_lies_is_named_and_not_taken_in() -> None:
    run, calm = result(lying(100.0, slice(AT, AT + 10))), result(epochs())
    assert (run.channel[AT : AT + 10] == FAULT).any(axis=0).tolist() == [i == SATELLITE for i in range(10)]
    assert (run.channel[AT : AT + 10, SATELLITE] == FAULT).all()
    assert (run.channel[AT + 10 :] == OK).all()
    assert np.abs(off(run) - off(calm)).max() < 3.0


def test_a_filter_that_is_wrong_comes_back_after_refusing() -> None:
    """Nine of ten lie for a while, each by its own: its doubt grows until it is carried off, and it begins anew."""
    spread = np.where(np.arange(10) % 2, 200.0, -200.0) * np.arange(10)
    value = epochs().value.copy()
    value[AT : AT + 8] += spread
    run = result(replace(epochs(), value=value))
    assert run.states.residual.refused[AT : AT + 8].any()
    assert (run.channel[-10:] == OK).mean() > 0.9
    assert off(run)[-10:].max() < 10.0


@pytest.mark.parametrize("far", [2e5, -2e5])
def test_a_filter_that_has_run_away_begins_anew(far: float) -> None:
    run = result(epochs())
    state = jax.tree.map(lambda x: x[AT], run.states)
    nav = state.residual.nav
    away = nav.position * (1 + far / np.linalg.norm(nav.position))
    state = state._replace(residual=state.residual._replace(nav=nav._replace(position=away)))
    rest = jax.tree.map(lambda x: x[AT + 1 :], samples(epochs().time, epochs().value, epochs().fresh, epochs().block))
    back = walk(judge(), rest, state)
    phase = back.states.residual.phase
    assert phase[0] < MOVING  # at once, whatever its own covariance says
    assert phase[-1] >= MOVING
    assert (
        np.linalg.norm(back.states.residual.nav.position - run.states.residual.nav.position[AT + 1 :], axis=1)[
            -5:
        ].max()
        < 15.0
    )


def test_left_out_late_the_bank_forgets_what_the_liar_told() -> None:
    """A ramp drags the state along until it is left out; then all go on from the filter that never had it."""
    value = epochs().value.copy()
    value[AT - 10 :, SATELLITE] += 3.0 * np.arange(len(value) - AT + 10)
    log = replace(epochs(), value=value)
    span = slice(AT - 10, None)
    with_bank, plain, never = (
        result(log, True),
        result(log),
        result(without(span, slice(SATELLITE, SATELLITE + 1)), True),
    )
    first = int(np.flatnonzero(with_bank.channel[:, SATELLITE] == FAULT)[0])
    accused = (with_bank.channel == FAULT).any(axis=0)
    assert accused.tolist() == [i == SATELLITE for i in range(10)]
    places = [run.states.residual.nav.position for run in (with_bank, never)]
    apart = np.linalg.norm(places[0] - places[1], axis=1)
    assert apart[first - 1] > 3.0
    assert np.median(apart[first:]) < 0.2
    # it is let in once more before it is left out for good; who was suspected with it stays as it was
    good = int(np.flatnonzero(with_bank.channel[:, SATELLITE] != FAULT)[-1]) + 1
    told_of = with_bank.reports.residual
    size = np.abs(told_of.value[first]) / np.sqrt(np.diag(told_of.cov[first]))
    others = size < 0.4 * size[SATELLITE]
    assert others.sum() == 8
    unlike = np.abs(told_of.value - never.reports.residual.value)[:, others]
    assert unlike[first].max() > 3.0
    assert unlike[good + 2 : good + 4].max() < 1.0
    late = np.linalg.norm(plain.states.residual.nav.position - places[1], axis=1)
    assert late[first:].max() > 2 * apart[first:].max()


def test_nobody_is_excluded_once_those_left_tell_no_position() -> None:
    few = without(slice(AT, None), slice(4, None))
    value = few.value.copy()
    value[AT, SATELLITE] += 100.0
    run = result(replace(few, value=value))
    assert run.channel[AT, SATELLITE] == UNKNOWN
    assert not (run.channel[AT] == FAULT).any()
    more = without(slice(AT, None), slice(5, None))
    value = more.value.copy()
    value[AT, SATELLITE] += 100.0
    assert result(replace(more, value=value)).channel[AT, SATELLITE] == FAULT
