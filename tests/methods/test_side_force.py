"""The recipe on simulated drives: a slide is a motion, a sensor's fault is none, and what it cannot run on."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.faults.motion import Felt, MotionFault, move
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import recipe
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.simulation.road import drive
from sensorfault.training.mounting import fit_mounting
from sensorfault.training.session import Session
from sensorfault.vehicles.car import roles

FELT = Felt((6, 7), (9, 10), True, (3, 4, 5), (0, 1, 2))


@cache
def log() -> Log:
    return drive(240.0, seed=3).log


@cache
def model() -> Model:
    return recipe("side-force").build(log().between(end_s=120.0), 0, Session())


def unseen() -> Log:
    return log().between(120.0)


def test_healthy_is_quiet() -> None:
    assert detect(model(), unseen()).events == ()


@pytest.mark.parametrize("fault", [MotionFault("side slip", 132.0, 2.0, 2.0), MotionFault("spin", 132.0, 2.0, -1.0)])
def test_a_slide_is_told_as_a_motion_at_once(fault: MotionFault) -> None:
    events = detect(model(), move(unseen(), fault, FELT)).events
    assert {(event.subject, event.sensor) for event in events} == {("motion", None)}
    assert fault.start_s <= events[0].start_s <= fault.start_s + 1.0


@pytest.mark.parametrize("axes", [(1, 1, 1), (-1, -1, -1)], ids=["as it is", "gravity told with the other sign"])
def test_left_is_left_for_units_of_either_kind(axes: tuple[int, int, int]) -> None:
    """In a left-hand bend the car is pushed to the left, whichever way the unit tells gravity."""
    value = log().value.copy()
    value[:, 3:6] *= axes
    value[:, 3:5] *= axes[2]  # a telephone: only gravity, here all of z, has the other sign
    mounted = fit_mounting(replace(log(), value=value), roles(log()))
    np.testing.assert_allclose(mounted.left, [0, 1, 0], atol=0.05)
    np.testing.assert_allclose(mounted.axis, [0, 0, 1], atol=0.05)


def test_a_side_force_that_does_not_follow_the_turning() -> None:
    value = log().value.copy()
    value[:, 4] *= -1
    with pytest.raises(LogError, match=r"side force is -[01]\.\d+ times speed times turn rate.*check the axes"):
        recipe("side-force").build(replace(log(), value=value), 0, Session())


def test_without_an_inertial_unit() -> None:
    part = log().select(c.path for c in log().channels if c.sensor != "gyro")
    with pytest.raises(LogError, match="no gyro with x, y, z"):
        recipe("side-force").build(part, 0, Session())
