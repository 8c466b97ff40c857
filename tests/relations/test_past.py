"""Limits by a log's own past."""

from dataclasses import replace

import numpy as np
import pytest

from sensorfault.relations import past, tests_of
from sensorfault.relations.grid import Grid
from sensorfault.relations.signals import Signal
from sensorfault.relations.table import Relation
from sensorfault.relations.tests_of import Piece

DURATION_S = 200.0
ENOUGH = 120.0  # from then on a test over 4 s knows four blocks


def piece(shake: np.ndarray, *devices: str) -> Piece:
    """One test of two devices over 4 s, in a vehicle whose gyro shows `shake` at 10 Hz."""
    time = np.arange(0.0, DURATION_S, 0.1)
    gyro = Signal("gyro", "gyro", "gyro", (0, 1, 2), time, np.stack([0 * time, 0 * time, shake], axis=1))
    blame = tuple(((device, ""), 1.0) for device in devices)
    test = tests_of.Test(Relation("a | b", "a|b", "family", 1, lambda grid: None, lambda grid: None, blame), 4.0)
    grid = Grid({"gyro": gyro}, 0.0, DURATION_S)
    return Piece(grid, (test,), np.zeros((len(grid.time), 1)), np.ones((len(grid.time), 1)))


def test_where_both_go_further_than_ever_the_past_allows_more() -> None:
    one = piece(np.full(2000, 0.1), "gnss", "wheel")
    time = one.grid.time
    moved = np.ones(len(time))
    further = replace(one, common=np.where(time > 150, 3.0, 1.0)[:, None])
    soon = np.searchsorted(time, 155.0)
    assert limits(further, moved)[soon] == pytest.approx(3 * limits(one, moved)[soon])
    np.testing.assert_array_equal(limits(further, moved)[time < 150], limits(one, moved)[time < 150])


def limits(one: Piece, moved: np.ndarray, fixed: float = 100.0, least: float = 0.1) -> np.ndarray:
    return past.limits(one, moved[:, None], np.array([fixed]), np.array([least]))[:, 0]


def test_the_largest_change_so_far_narrows_the_limit() -> None:
    one = piece(np.full(2000, 0.1), "gnss", "wheel")
    time = one.grid.time
    moved = np.where(time < 10, 2.0, 1.0)
    limit = limits(one, moved)
    assert (limit[time < 80] == 100.0).all()  # the past says nothing yet
    later = limit[time > ENOUGH]
    assert (later >= past.MOST * 2.0).all()
    assert (later <= past.MOST * 2.0 * 1.25).all()
    assert (limits(one, moved, least=50.0)[time > ENOUGH] == 50.0).all()
    assert (limits(one, moved, fixed=3.0) == 3.0).all()


def test_what_happens_now_is_not_its_own_past() -> None:
    one = piece(np.full(2000, 0.1), "gnss", "wheel")
    time = one.grid.time
    quiet, loud = np.ones(len(time)), np.where(time > 150, 50.0, 1.0)
    soon = time < 150 + past.BLOCK_S
    np.testing.assert_array_equal(limits(one, loud)[soon], limits(one, quiet)[soon])


def test_a_wilder_motion_widens_the_limits() -> None:
    rate = np.arange(0.0, DURATION_S, 0.1)
    calm, wild = piece(np.full(2000, 0.1), "gnss", "wheel"), piece(np.where(rate > 150, 0.4, 0.1), "gnss", "wheel")
    time = calm.grid.time
    moved = np.ones(len(time))
    before, after = limits(calm, moved), limits(wild, moved)
    np.testing.assert_array_equal(before[time < 149], after[time < 149])
    soon = np.searchsorted(time, 175.0)
    assert after[soon] == pytest.approx(before[soon] * 16, rel=0.05)
    # also the limits of a class, beyond what they allow
    of_class = limits(wild, moved, fixed=0.5, least=0.5)
    assert of_class[soon] == pytest.approx(0.5 * (4 / past.NOVEL) ** 2, rel=0.05)


def test_a_suspect_does_not_say_how_the_vehicle_moves() -> None:
    one = piece(np.full(2000, 0.1), "gnss", "gyro")
    assert (limits(one, np.ones(len(one.grid.time))) == 100.0).all()
