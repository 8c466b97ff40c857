"""The recall table, from outcomes made by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest

from evaluation.detections import detection, event, quiet
from sensorfault.evaluation.cells import tabulate
from sensorfault.evaluation.judge import GRACE_S, Outcome, judge
from sensorfault.faults.fault import Fault

BIAS = Fault("offset", "gyro", "x", 100.0, 5.0, 3.0, sigmas=True)
HIT = Outcome(BIAS, True, 1.0, True, True, True, event(101.0), 0, 4.0, 1.0)
MISSED = Outcome(BIAS, False, math.nan, False, False, False, None, 0, 4.0, 4.0)


def test_one_cell_counts_its_group() -> None:
    outcomes = [HIT, replace(HIT, delay_s=3.0, channel_right=False, error_after=2.0), MISSED, MISSED]
    (cell,) = tabulate(outcomes, detection())
    assert (cell.kind, cell.channel, cell.magnitude, cell.faults) == ("offset", "gyro.x", 3.0, 4)
    assert cell.recall == 0.5
    assert cell.delay_p50_s == 2.0
    assert cell.delay_p95_s == pytest.approx(2.9)
    assert (cell.sensor_right, cell.channel_right, cell.kind_right) == (1.0, 0.5, 1.0)
    assert cell.recovery == pytest.approx(np.median([0.25, 0.5, 1.0, 1.0]))
    assert cell.chance == 0.0


def test_nothing_found_has_no_delay_and_no_isolation() -> None:
    (cell,) = tabulate([replace(MISSED, error_before=math.nan)], detection())
    assert cell.recall == 0
    assert all(math.isnan(x) for x in (cell.delay_p50_s, cell.delay_p95_s, cell.sensor_right, cell.recovery))


def test_a_cell_for_each_kind_channel_and_magnitude_in_order() -> None:
    faults = [
        Fault("missing", "gyro", None, 1.0, 5.0),
        replace(BIAS, magnitude=10.0),
        replace(BIAS, sensor="gnss", channel="east"),
        BIAS,
        Fault("spike", "gyro", "y", 1.0, 0.0, 3.0),
        BIAS,
    ]
    cells = tabulate([replace(MISSED, fault=fault) for fault in faults], detection())
    assert [(cell.kind, cell.magnitude, cell.channel, cell.faults) for cell in cells] == [
        ("spike", 3.0, "gyro.y", 1),
        ("offset", 3.0, "gnss.east", 1),
        ("offset", 3.0, "gyro.x", 2),
        ("offset", 10.0, "gyro.x", 1),
        ("missing", 0.0, "gyro", 1),
    ]


def test_chance_is_the_share_of_windows_with_an_alarm() -> None:
    """By brute force: slide a window of the fault's length and grace over the untouched run."""
    starts = [100.0, 101.0, 300.0, 305.5, 700.0]
    (cell,) = tabulate([HIT], detection([event(start) for start in starts]))
    window = BIAS.duration_s + GRACE_S
    begins = np.arange(0, 1000, 0.01)
    alarmed = np.any([(begins <= s) & (s <= begins + window) for s in starts], axis=0)
    assert cell.chance == pytest.approx(alarmed.mean(), abs=1e-3)


def test_one_who_always_cries_has_a_chance_of_one() -> None:
    (cell,) = tabulate([HIT], detection([event(float(start)) for start in range(1000)]))
    assert cell.chance == pytest.approx(1.0, abs=0.01)
    assert cell.chance <= 1.0


@pytest.mark.parametrize("an_hour", [20, 200, 2000])
def test_random_alarms_get_no_credit(an_hour: int) -> None:
    """Who cries at random finds as many faults as chance says, however often he cries."""
    rng = np.random.default_rng(an_hour)
    log = quiet(4000.0)
    found, chance = [], []
    for _ in range(min(10, 2000 // an_hour)):  # the more alarms, the less a draw of them varies
        cries = rng.uniform(0, 4000, (2, round(an_hour * 4000 / 3600)))
        clean, lying = (detection([event(float(start)) for start in sorted(times)], log) for times in cries)
        faults = [replace(BIAS, start_s=float(start)) for start in np.sort(rng.uniform(0, 3990, 100))]
        (cell,) = tabulate(judge(lying, faults).outcomes, clean)
        found.append(cell.recall)
        chance.append(cell.chance)
    assert np.mean(found) == pytest.approx(np.mean(chance), abs=0.04)


def test_one_endless_alarm_gets_no_credit() -> None:
    faults = [replace(BIAS, start_s=float(start)) for start in range(50, 950, 20)]
    (cell,) = tabulate(judge(detection([event(1.0, None)]), faults).outcomes, detection([event(1.0, None)]))
    assert cell.recall == 0.0
