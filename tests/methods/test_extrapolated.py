"""Persistence and linear extrapolation on the joints of an arm."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.core.verdicts import FAULT, UNKNOWN
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import LogError
from sensorfault.methods.position.extrapolated import from_last
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.simulation.arm import run

NAMES = ("persistence", "linear-extrapolation")


@cache
def model(order: int) -> Model:
    return from_last(NAMES[order], run(seed=1, samples=400), order)


@pytest.mark.parametrize("order", [0, 1])
def test_each_joint_by_itself(order: int) -> None:
    log = run(seed=2)
    result = replay_log(uncalibrated(model(order).monitor), log)
    x = log.value[:, :4]
    want = x[1:] - x[:-1] if order == 0 else x[2:] - (2 * x[1:-1] - x[:-2])
    np.testing.assert_allclose(result.residual[1 + order :, :4], want, atol=1e-9)
    assert (result.channel[: 1 + order] == UNKNOWN).all()
    assert (result.channel[:, 4:] == UNKNOWN).all()
    assert model(order).watched == (True,) * 4 + (False,) * 2


@pytest.mark.parametrize("order", [0, 1])
def test_two_lie_and_two_are_accused(order: int) -> None:
    faults = [Fault("offset", sensor, None, 0.05, 0.01, 0.5) for sensor in ("tachometer1", "encoder2")]
    found = detect(model(order), inject(run(seed=2), faults).log)
    assert (found.channel[50:60, [0, 3]] == FAULT).all()
    assert not (found.channel[:, [1, 2]] == FAULT).any()
    assert {event.sensor for event in found.events} == {"tachometer1", "encoder2"}
    assert not (found.channel[62:] == FAULT).any()


def test_an_arm_at_rest_is_refused() -> None:
    log = run(seed=1)
    with pytest.raises(LogError, match="no channel to watch"):
        from_last(NAMES[0], replace(log, value=np.zeros_like(log.value)), 0)
