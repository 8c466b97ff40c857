"""The GNSS/INS filter against one in plain NumPy, which begins where ours is aligned: oracles/navigator.py."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from laws.walk import Walk, walk
from oracles.navigator import L1, LIGHT, SIGN, Navigator, State, ahead, derivative, expected, growth
from sensorfault.core.types import Sample
from sensorfault.logs.epochs import framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import ASIDE_M_S, SIGMA, WHEEL_M_S, Filter, monitor, navigation
from sensorfault.numerics.alignment import ALIGNED, forward
from sensorfault.numerics.ins_error import transition
from sensorfault.numerics.strapdown import Rows, advance
from sensorfault.runtime.runners import samples
from sensorfault.simulation.ride import Ride
from sensorfault.simulation.train import ride
from sensorfault.stages.residual.ins_belief import Belief
from sensorfault.stages.residual.ins_gnss import InsGnss

HZ, STRETCH = 10, 6  # rows of the first of two stretches: half of the slots for a row, which are one second's and two
DENSITY = np.repeat([1e-3, 0.1, 0.0, 1e-5, 1e-4, 0.1, 0.19], [3, 3, 3, 3, 3, 1, 1]) ** 2
BLOCKS = {"psi": 0, "vel": 3, "pos": 6, "gyro": 9, "acc": 12, "clock": 15}


class Run(NamedTuple):
    residual: InsGnss
    epochs: Log
    result: Walk
    begins: int  # the first epoch after which it navigates

    @property
    def belief(self) -> Belief:
        belief: Belief = self.result.states.residual
        return belief

    @property
    def rest(self) -> range:
        return range(self.begins + 1, min(self.begins + 26, len(self.epochs)))


@cache
def train(seed: int = 1) -> Ride:
    return ride(90.0, seed=seed, noise="gaussian", imu_hz=HZ)


@cache
def run(rates: bool = False, bank: bool = False) -> Run:
    """Through the filter, with the wheels' speed where it takes range rates."""
    made = train()
    how = framing(made.log, made.sky.names, rates)
    epochs = how.frame(made.log)
    if rates:
        at = np.searchsorted(made.log.time, epochs.time - 1e-6)
        epochs = replace(epochs, block=epochs.block._replace(ahead=np.linalg.norm(made.velocity[at], axis=1)))
    residual = navigation(how, Filter(bank=bank))
    result = walk(monitor(how, residual), samples(epochs.time, epochs.value, epochs.fresh, epochs.block))
    return Run(residual, epochs, result, int(np.flatnonzero(result.states.residual.phase == ALIGNED)[0]))


def at(belief: Belief, k: int, apart: int | None = None) -> Navigator:
    """What ours believes after epoch k; `apart`: of its bank, without that satellite."""
    b = jax.tree.map(lambda x: x[k], belief)
    state = State(*b.nav[:2], b.nav.position, b.own.gyro, b.own.force, float(b.own.clock), float(b.own.drift))
    if apart is None:
        return Navigator(state, SIGN[:, None] * b.cov * SIGN)
    return Navigator(state.moved(SIGN * b.apart[apart]), SIGN[:, None] * b.covs[apart] * SIGN)


def oracle(of: Run, start: Navigator, rates: bool = False, without: int | None = None) -> tuple[list, list, list]:
    """States, innovations in the channels' units and their variances, at each epoch of the rest."""
    epochs, states, innovations, variances = of.epochs, [], [], []
    unit = np.repeat([1.0, -L1 / LIGHT], of.epochs.value.shape[1] // 2) if rates else np.ones(epochs.value.shape[1])
    now = start
    for k in of.rest:
        b = jax.tree.map(lambda x, k=k: x[k], epochs.block)
        real = b.dt > 0
        for rows in (np.arange(12) < STRETCH, np.arange(12) >= STRETCH):
            now = now.carried(b.gyro[rows & real], b.force[rows & real], 1 / HZ, DENSITY)
        there = epochs.fresh[k]
        received = np.isfinite(b.place).all(axis=1)
        each = np.tile(received, 1 + rates)

        def model(x: State, _: object = None, b=b, received=received) -> np.ndarray:
            return expected(x, b.place[received], b.speed[received], rates)

        h = np.zeros((len(there), 17))
        h[each] = derivative(model, now.state)
        h[len(received) :, 6:9] = 0.0  # how a line of sight turns with the position is left out: 2e-4 of a range's rate
        z = np.zeros(len(there))
        z[each] = epochs.value[k][each] - model(now.state)
        r = noise(now.state, b.place, rates)
        innovations.append(z)
        variances.append(np.einsum("ij,jk,ik->i", h, now.cov, h) + r)
        taken = there & (np.arange(len(there)) % len(received) != (-1 if without is None else without))
        z, h, r = z / unit, h / unit[:, None], r / unit**2
        z, h, r = z[taken], h[taken], r[taken]
        if np.isfinite(b.ahead):
            z = np.concatenate([z, np.array([b.ahead, 0.0, 0.0]) - ahead(now.state)])
            h = np.concatenate([h, derivative(lambda x, _: ahead(x), now.state)])
            r = np.concatenate([r, np.array([WHEEL_M_S, ASIDE_M_S, ASIDE_M_S]) ** 2])
        now = now.result(z, h, r)
        states.append(now.state)
    return states, innovations, variances


def noise(x: State, places: np.ndarray, rates: bool) -> np.ndarray:
    """Variances that the filter takes for granted, in the channels' units."""
    zenith, horizon, scale = SIGMA
    sight = np.where(np.isfinite(places), places, x.place * 4) - x.place
    up = x.place / [1.0, 1.0, 0.99330562]  # normal of the ellipsoid
    elevation = np.arcsin(sight @ up / np.linalg.norm(sight, axis=1) / np.linalg.norm(up))
    ranges = (zenith + horizon * np.exp(-elevation / scale)) ** 2
    return np.concatenate([ranges, np.full(len(ranges), (0.1 * L1 / LIGHT) ** 2)]) if rates else ranges


def worst(of: Run, states: list) -> tuple[float, float]:
    """How far position [m] and attitude [rad] are from the oracle's at most."""
    nav = jax.tree.map(lambda x: x[of.rest], of.belief.nav)
    place = np.linalg.norm(nav.position - np.stack([x.place for x in states]), axis=1)
    return place.max(), np.abs(nav.attitude - np.stack([x.attitude for x in states])).max()


def test_it_goes_as_the_oracle_does() -> None:
    """Innovations of metres to 0.1 mm, variances to 3e-5.

    What is left is of first order: the package takes the mean attitude and force of half a second for all of it, the
    radial part of gravity's gradient alone, and a line of sight as if the earth did not turn under it.
    """
    own = run()
    states, innovations, variances = oracle(own, at(own.belief, own.begins))
    place, attitude = worst(own, states)
    assert place < 1e-4
    assert attitude < 1e-5
    result = jax.tree.map(lambda x: x[own.rest], own.result.reports.residual)
    there = result.valid
    assert there.sum() > 200
    assert np.abs(result.value[there]).mean() > 1.0
    np.testing.assert_allclose(result.value[there], np.stack(innovations)[there], atol=1e-4)
    np.testing.assert_allclose(np.einsum("tii->ti", result.cov)[there], np.stack(variances)[there], rtol=3e-5)


def test_with_range_rates_and_wheels_it_does_so_too() -> None:
    own = run(rates=True, bank=True)
    place, attitude = worst(own, oracle(own, at(own.belief, own.begins), rates=True)[0])
    assert place < 1e-4
    assert attitude < 1e-5


@pytest.mark.parametrize("member", [0, 9])
def test_a_member_of_the_bank_is_a_filter_that_never_got_its_satellite(member: int) -> None:
    """To a hundredth of its deviation: the bank is linear about one nominal state, the oracle about its own."""
    own = run(rates=True, bank=True)
    start = at(own.belief, own.begins, member)
    _, innovations, variances = oracle(own, start, rates=True, without=member)
    both = [member, member + len(own.residual.system)]
    result = jax.tree.map(lambda x: x[own.rest], own.result.reports.residual)
    assert result.valid[:, both].all()
    spread = np.sqrt(np.stack(variances)[:, both])
    np.testing.assert_allclose(result.value[:, both] / spread, np.stack(innovations)[:, both] / spread, atol=0.01)
    np.testing.assert_allclose(np.einsum("tii->ti", result.cov)[:, both], spread**2, rtol=3e-3)
    with pytest.raises(AssertionError):  # while the filter that got it says something else
        np.testing.assert_allclose(
            result.value[:, both] / spread, np.stack(oracle(own, start, True)[1])[:, both] / spread, atol=0.01
        )


def test_innovations_scatter_as_the_filter_claims() -> None:
    own = run()
    result = own.result.reports.residual
    there = result.valid & (own.belief.phase == ALIGNED)[:, None]
    assert there.sum() > 400
    assert 0.9 < (result.value / np.sqrt(np.einsum("tii->ti", result.cov)))[there].std() < 1.1


def test_every_block_of_the_transition() -> None:
    own = run()
    k = own.begins + 5
    b = jax.tree.map(lambda x: x[k], own.belief)
    epoch = jax.tree.map(lambda x: x[k + 1][:HZ] if x.ndim > 1 else x[k + 1], own.epochs.block)
    rows = Rows(*(jnp.asarray(x) for x in (epoch.gyro - b.own.gyro, epoch.force - b.own.force, epoch.dt, epoch.ok)))
    start = jax.tree.map(jnp.asarray, b.nav)
    end, way = advance(start, rows, jnp.asarray(True))
    ours = np.asarray(transition(end, way, 17)) - np.eye(17)
    middle = at(own.belief, k).state
    theirs = np.zeros((17, 17))
    turn = np.asarray(way.attitude)
    for gyro, force in zip(epoch.gyro, epoch.force, strict=True):
        theirs += growth(replace(middle, attitude=turn), gyro, force) / HZ
    theirs *= SIGN[:, None] * SIGN
    seen = 0
    for one, i in BLOCKS.items():
        for other, j in BLOCKS.items():
            block = np.s_[i : i + 3, j : j + 3]
            size = np.abs(theirs[block]).max()
            mine, yours = ours[block], theirs[block]
            if (one, other) == ("vel", "pos"):  # of gravity's gradient the package has the part along the vertical
                plumb = middle.place / np.linalg.norm(middle.place)
                mine, yours = mine @ plumb, yours @ plumb
            np.testing.assert_allclose(mine, yours, atol=0.02 * size + 1e-12, err_msg=f"{one}, {other}")
            seen += size > 1e-9
    assert seen == 8


def test_every_line_of_the_measurements() -> None:
    own = run(rates=True, bank=True)
    k = own.begins + 5
    sample = samples(own.epochs.time, own.epochs.value, own.epochs.fresh, own.epochs.block)
    sample = Sample(*jax.tree.map(lambda x: x[k + 1], tuple(sample)))
    belief = jax.tree.map(lambda x: jnp.asarray(x[k]), own.belief)
    lines = own.residual.evaluate(belief, sample)[1]
    now = at(jax.tree.map(lambda x: np.asarray(x)[None], lines.prior), 0).state
    there = np.isfinite(own.epochs.block.place[k + 1]).all(axis=1)
    places, speeds = own.epochs.block.place[k + 1][there], own.epochs.block.speed[k + 1][there]
    theirs = derivative(lambda x, _: expected(x, places, speeds, True), now)
    ours = np.asarray(lines.lines.rows)[np.tile(there, 2)] * SIGN
    ranges = len(places)
    np.testing.assert_allclose(ours[:ranges], theirs[:ranges], atol=3e-6)
    rates = theirs[ranges:] / (-L1 / LIGHT)
    assert np.abs(rates[:, 6:9]).max() < 3e-4  # left out
    np.testing.assert_allclose(np.delete(ours[ranges:], np.s_[6:9], 1), np.delete(rates, np.s_[6:9], 1), atol=3e-6)
    speed, by = forward(jnp.asarray(now.attitude), jnp.asarray(now.velocity))
    np.testing.assert_allclose(speed, ahead(now))
    np.testing.assert_allclose(by, derivative(lambda x, _: ahead(x), now)[:, :6], atol=1e-6)
