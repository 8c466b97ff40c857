"""The arm's filter as a recipe: what it finds, whom it accuses, what it cannot run on."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import LogError
from sensorfault.methods.arm.arm_kalman import arm_kalman
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.runtime.store import load, save
from sensorfault.simulation.arm import AS_PRINTED, PHYSICAL, run


@cache
def model() -> Model:
    return arm_kalman("arm-kalman", run(seed=1000, samples=500))


def test_the_papers_two_drifts_at_once() -> None:
    drifts = [
        Fault("drift", sensor, None, 0.05, 0.05, size) for sensor, size in (("tachometer2", 48), ("encoder2", 36))
    ]
    found = detect(model(), inject(run(seed=1), drifts).log)
    first = [int(np.argmax(column == FAULT)) for column in found.channel[:, [1, 3]].T]
    assert first == [51, 51]
    assert not (found.channel[:, [0, 2]] == FAULT).any()
    assert {event.sensor for event in found.events} == {"tachometer2", "encoder2"}


def test_its_innovations_are_as_large_as_it_says() -> None:
    score = np.concatenate([np.asarray(replay_log(model().monitor, run(seed=s)).scores[0]) for s in range(20)])
    np.testing.assert_allclose(np.nanmean(score**2, axis=0), 1.0, atol=0.3)
    assert (score[np.isfinite(score)] > 3.89).sum() <= 5


def test_saved_and_loaded_it_says_the_same(tmp_path: Path) -> None:
    save(model(), tmp_path / "arm.sensorfault")
    again = load(tmp_path / "arm.sensorfault")
    one, two = (replay_log(m.monitor, run(seed=4)) for m in (model(), again))
    np.testing.assert_array_equal(one.residual, two.residual)
    np.testing.assert_array_equal(one.channel, two.channel)
    assert again.summary["arm"]["a5"] == 24.6


def test_other_logs_are_refused() -> None:
    for one, other in ((AS_PRINTED, PHYSICAL), (PHYSICAL, AS_PRINTED)):  # which differ in a5, by a likely misprint
        with pytest.raises(LogError, match="not of the arm of arm-kalman"):
            arm_kalman("arm-kalman", run(one, seed=3), other.constants)
    log = run(seed=1)
    with pytest.raises(LogError, match="1 channels called torque"):
        arm_kalman("arm-kalman", log.select(channel.path for channel in log.channels[:5]))
    with pytest.raises(LogError, match="15 rows with every rate and angle"):
        arm_kalman("arm-kalman", log.between(end_s=0.0149))
    gone = replace(log, value=np.where(np.arange(6) == 1, np.nan, log.value), fresh=log.fresh & (np.arange(6) != 1))
    with pytest.raises(LogError, match="0 rows"):
        arm_kalman("arm-kalman", gone)
