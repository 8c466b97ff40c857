"""Condition (c): the labels lie on their ranges, and leaving out what is late brings the car nearer to its truth."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.evaluation.ranking import auc
from sensorfault_studies.wang2023.navigated import horizontal
from sensorfault_studies.wang2023.nlos import WAYS, _known_place, scores, through
from sensorfault_studies.wang2023.smartloc import Town, town

LATE, NONE = (
    next(way for way in WAYS if way.condition == "carrier" and way.method == m) for m in ("late", "no-exclusion")
)


@pytest.fixture
def of(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> Town:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    return town()


def test_horizontal_leaves_out_height() -> None:
    true = np.array([[6378137.0, 0.0, 0.0]])
    assert horizontal(true + np.array([50.0, 3.0, 4.0]), true) == pytest.approx([5.0])


@pytest.mark.real
def test_labels_lie_on_their_ranges(of: Town) -> None:
    late, gps = _known_place(of), np.array([name[0] == "G" for name in of.names])
    out, straight = (late[(of.nlos == label) & gps] for label in (1, 0))
    assert len(out) == 1368
    assert np.median(out) == pytest.approx(35.0, abs=2.0)
    assert np.median(np.abs(straight)) < 3.0
    known = np.isfinite(of.nlos) & gps
    assert auc(late[known], of.nlos[known] == 1) == pytest.approx(0.92, abs=0.01)


@pytest.mark.real
def test_wheels_say_what_the_truth_does(of: Town) -> None:
    log, time = of.log, of.log.time
    velocity = np.gradient(of.position, time, axis=0)
    speed = log.value[:, log.index("wheel.speed")]
    assert np.corrcoef(speed, np.linalg.norm(velocity, axis=1))[0, 1] > 0.98
    # down is positive when turning to the right, and so is the force to the right
    turn = log.value[:, log.index("gyro.z")]
    up = of.position[0] / np.linalg.norm(of.position[0])
    fast = (speed > 3)[1:-1]
    over = np.cross(velocity[2:], velocity[:-2]) @ up  # proportional, at one speed; nobody's truth is smooth at 5 Hz
    assert np.corrcoef(turn[1:-1][fast], over[fast])[0, 1] > 0.7
    np.testing.assert_allclose(log.value[:, log.index("accelerometer.y")], speed * turn)
    assert log.value[0, log.index("accelerometer.z")] == pytest.approx(-9.8128, abs=2e-3)


@pytest.mark.real
def test_leaving_out_what_is_late_halves_the_error(of: Town) -> None:
    with_all, without = (scores(of, through(of, way, wheels=True)) for way in (NONE, LATE))
    assert with_all["rejected_fraction"] == 0.0
    assert without["error_p50_m"] < 0.7 * with_all["error_p50_m"]
    assert without["error_p95_m"] < 0.7 * with_all["error_p95_m"]
    assert without["auc"] > 0.83
    assert without["auc_gps"] > 0.86
    assert without["recall"] > 2 * without["far"]
