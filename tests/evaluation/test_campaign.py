"""Many faults into a healthy log, and what comes of them."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import fitted
from sensorfault.evaluation import campaign as module
from sensorfault.evaluation.campaign import MAGNITUDES, Campaign, campaign
from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import LogError

KINDS = ("spike", "offset", "frozen", "missing")


@cache
def done() -> Campaign:
    return campaign(fitted.model(), fitted.unseen(), KINDS, duration_s=2.0, repeats=2)


def test_every_kind_on_every_watched_channel_at_every_magnitude() -> None:
    cells = done().cells
    paths = [channel.path for channel in fitted.CHANNELS[:6]]
    for kind in ("spike", "offset", "frozen"):
        mine = {(cell.channel, cell.magnitude) for cell in cells if cell.kind == kind}
        assert mine == {(path, size) for path in paths for size in MAGNITUDES[kind]}
    assert {cell.channel for cell in cells if cell.kind == "missing"} == {"gyro", "accelerometer", "gnss"}
    assert all(cell.faults == 2 for cell in cells)
    assert len(done().outcomes) == 2 * len(cells)


def test_what_is_plain_is_found() -> None:
    for cell in done().cells:
        if cell.kind in ("frozen", "missing") or cell.magnitude == 20.0:
            assert cell.recall == 1.0, cell
            assert cell.sensor_right == 1.0, cell
            assert 0 <= cell.delay_p50_s <= cell.delay_p95_s < 1.0
        assert cell.chance == 0.0  # the untouched run has no alarm


def test_larger_faults_are_found_at_least_as_often() -> None:
    for kind in ("spike", "offset"):
        by_size = {
            size: [c.recall for c in done().cells if (c.kind, c.magnitude) == (kind, size)] for size in (3.0, 20.0)
        }
        assert np.mean(by_size[3.0]) <= np.mean(by_size[20.0])


def test_the_rest_of_the_answer() -> None:
    assert done().untouched.outcomes == ()
    assert done().untouched.false_alarms == ()
    assert done().untouched.healthy_hours == pytest.approx(fitted.unseen().duration_s / 3600)
    assert 0.5 < done().auc <= 1.0
    assert 0 < done().auc_pr <= 1.0
    counts = done().isolation()
    assert sum(sum(row.values()) for row in counts.values()) == sum(one.found for one in done().outcomes)
    assert set(counts) <= {"gyro", "accelerometer", "gnss"}
    assert all(row.get(of, 0) >= 0.8 * sum(row.values()) for of, row in counts.items())


def test_stand_ins_are_better_than_the_faulty_value() -> None:
    biased = [cell.recovery for cell in done().cells if (cell.kind, cell.magnitude) == ("offset", 20.0)]
    assert np.median(biased) < 0.2


def test_it_can_be_repeated() -> None:
    result: list[float] = []
    kinds = ("frozen",)
    one, again, other = (
        campaign(fitted.model(), fitted.unseen(), kinds, duration_s=2.0, repeats=1, seed=seed, progress=result.append)
        for seed in (3, 3, 4)
    )
    assert one == again
    assert [o.fault.start_s for o in one.outcomes] != [o.fault.start_s for o in other.outcomes]
    assert result[: len(result) // 3] == sorted(result[: len(result) // 3])
    assert result[-1] == 1.0


def test_a_sensor_too_slow_to_be_missed_in_time_is_left_out() -> None:
    """In half a second of silence a 10 Hz fix is overdue; in a quarter it is not."""
    for duration_s, sensors in ((0.5, {"gyro", "accelerometer", "gnss"}), (0.25, {"gyro", "accelerometer"})):
        cells = campaign(fitted.model(), fitted.unseen(), ("missing",), duration_s=duration_s, repeats=1).cells
        assert {cell.channel for cell in cells} == sensors
    assert MISSED == 3.0


def test_faults_never_meet() -> None:
    by_batch: dict[int, list[tuple[float, float]]] = {}
    last = np.inf
    for one in done().outcomes:
        batch = len(by_batch) - (one.fault.start_s > last)
        by_batch.setdefault(batch, []).append((one.fault.start_s, one.fault.end_s))
        last = one.fault.start_s
    for spans in by_batch.values():
        for (_, end), (start, _) in pairwise(spans):
            assert start - end >= module.PAUSE_S - 0.1


@pytest.mark.parametrize("length_s", [5.0, 11.0])
def test_too_short_a_log(length_s: float) -> None:
    log = fitted.unseen().between(end_s=fitted.LEARN_S + length_s)
    with pytest.raises(LogError, match=r"needs 12 s; give a longer part, or shorter faults\.$"):
        campaign(fitted.model(), log, duration_s=2.0)
