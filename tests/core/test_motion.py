"""The verdict on the vehicle's motion: by its own branches, and silent while sensors lie."""

from dataclasses import replace

import numpy as np
import pytest

from core.scripted import branch, each, says, script, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN

ROWS = 8


def judged(memory_s: float = 0.0, hold_s: float = 0.0) -> Monitor:
    """Two sensors, each judged by itself, and their motion by the second branch."""
    of_motion = replace(branch(each(2, 1)), subject="motion", memory_s=memory_s)
    return says([branch(each(2)), of_motion], (0, 1), most=1, hold_s=hold_s)


def scores(sensor: dict[int, float], motion: dict[int, float]) -> tuple[np.ndarray, np.ndarray]:
    result = np.zeros((ROWS, 2)), np.zeros((ROWS, 2))
    for one, large in zip(result, (sensor, motion), strict=True):
        for row, value in large.items():
            one[row, 0] = value
    return result


def test_an_alarm_of_motion_accuses_no_sensor() -> None:
    seen = walk(judged(), script(scores({}, {3: 5.0})))
    np.testing.assert_array_equal(seen.reports.verdict.motion, [OK] * 3 + [FAULT] + [OK] * 4)
    assert (seen.channel == OK).all()
    assert (seen.sample == OK).all()
    assert seen.reports.trust.measured.all()


def test_it_is_unknown_while_a_sensor_lies_and_for_its_memory_after() -> None:
    seen = walk(judged(memory_s=2.0), script(scores({2: 5.0}, {2: 5.0, 3: 5.0, 5: 5.0})))
    np.testing.assert_array_equal(seen.reports.verdict.motion, [OK] * 2 + [UNKNOWN] * 3 + [FAULT] + [OK] * 2)
    assert seen.channel[2, 0] == FAULT


def test_without_a_test_it_stands_for_as_long_as_the_slowest_sensor_is_held() -> None:
    fresh = np.ones((ROWS, 2), bool)
    fresh[3:7] = False
    seen = walk(judged(hold_s=2.0), script(scores({}, {2: 5.0}), fresh=fresh))
    np.testing.assert_array_equal(seen.reports.verdict.motion, [OK] * 2 + [FAULT] * 3 + [UNKNOWN] * 2 + [OK])


@pytest.mark.parametrize("excuses", [True, False])
def test_a_slide_excuses_the_sensors_that_it_explains(excuses: bool) -> None:
    """From the sample after it is seen, for the memory of the sensor's branch; the other branch is not excused."""
    presuming = replace(branch(each(2)), memory_s=2.0)
    of_motion = replace(branch(each(2, 1)), subject="motion", excuses=excuses)
    monitor = says([presuming, of_motion, branch(each(2, 2))], (0, 1))
    result = [np.zeros((ROWS, 2)) for _ in range(3)]
    result[0][1:8, 0] = 5.0  # accused by what presumes the model ...
    result[1][[0, 2], 0] = 5.0  # slides
    result[2][7, 1] = 5.0
    seen = walk(monitor, script(tuple(result)))
    # what slides at 2 s is heard only where the sensor was excused by then
    np.testing.assert_array_equal(seen.channel[1:, 0], [OK] * 4 + [FAULT] * 3 if excuses else [FAULT] * 7)
    np.testing.assert_array_equal(seen.channel[:, 1], [OK] * 7 + [FAULT])


def test_a_monitor_that_does_not_judge_motion_does_not_know_it() -> None:
    seen = walk(says([branch(each(2))], (0, 1)), script(scores({}, {})[0]))
    assert (seen.reports.verdict.motion == UNKNOWN).all()


def test_a_branch_judges_sensors_or_motion() -> None:
    one = branch(each(2))
    with pytest.raises(ValueError, match="take one of sensor, motion"):
        Branch(one.statistic, one.threshold, subject="weather")
