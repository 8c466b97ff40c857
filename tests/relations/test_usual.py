"""How fast two witnesses part all the time: known from the past only."""

import numpy as np
import pytest

from relations import drives
from sensorfault.relations.judge import AGREES_S, _distrusted, judge
from sensorfault.runtime.compared import compare, comparison_of


def test_what_begins_later_changes_nothing_before() -> None:
    known = comparison_of(drives.copter(seed=1), drives.copter(seed=2))
    log = drives.copter(300.0)
    later = drives.changed(log, "gnss.altitude", 200.0, 300.0, lambda t, x: x + 1.0 * (t - 200))
    for learned in (known.learned, None):
        before, after = judge(log, learned), judge(later, learned)
        early = before.pieces[0].grid.time < 199
        names = [test.key for test in before.pieces[0].tests]
        assert names == [test.key for test in after.pieces[0].tests]
        moved = [judged.pieces[0].moved[early] for judged in (before, after)]
        if learned is not None:  # without a fit the limits, in whose units scores are, are those of the log
            np.testing.assert_allclose(*(judged.scores[0][early] for judged in (before, after)), atol=1e-9)
        np.testing.assert_allclose(*moved, atol=1e-9)
    first = compare(later, known).events[0]
    assert first.sensor == "gnss"
    assert first.start_s >= 199.0


def test_the_zero_of_a_gyro_is_no_fault() -> None:
    log = drives.car(240.0, seed=4)
    off = drives.changed(log, "gyro.z", 0.0, 240.0, lambda t, x: x + 0.015)
    assert compare(off).events == ()


@pytest.mark.parametrize("agrees", [True, False])
def test_a_wrong_attitude_turns_nothing_until_it_agrees_for_a_minute(agrees: bool) -> None:
    alarm, over = np.zeros(1000, bool), np.zeros(1000, bool)
    alarm[100:110] = True
    over[300] = not agrees
    minute = round(AGREES_S / 0.2)
    found = _distrusted(alarm, over)
    assert not found[:100].any()
    end = (109 if agrees else 300) + minute
    assert found[100 : end + 1].all()
    assert not found[end + 1 :].any()
    assert not _distrusted(np.zeros(1000, bool), ~over).any()
