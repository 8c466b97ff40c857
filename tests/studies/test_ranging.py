"""Real ranges: what the files hold, and what the gates make of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs.table import LogError
from sensorfault.methods.ranging.range_filter import Filter, cubature, followed
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023 import receivers, robots, rovers, walks
from sensorfault_studies.xu2023.gates import ALL, FITTED, Watched, compared, early, watching
from sensorfault_studies.xu2023.receivers import Dive, impossible
from sensorfault_studies.xu2023.run import through
from sensorfault_studies.xu2023.scenario import Scenario

ROWS = 2560  # compiled for


@pytest.fixture
def real(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    return real_data


def followed_by(case: Scenario, q: float, sigma_m: float) -> Watched:
    """With a noise that is given, which takes no time."""
    log = early(case)
    found = followed("test", log)
    filter = Filter(q, sigma_m)
    return Watched("one", case, watching(log, found, filter, lambda filter: cubature(log, found, filter)))


def test_ranges_that_break_the_triangle() -> None:
    """Receivers at 0, 1, 2 and 3 m on a line; 100 m away, nearly in line."""
    places = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    right = np.array([100.0, 99, 98, 97])
    one = right + np.array([0, 6, 0, 0])
    pair = np.array([100.0, 106, np.nan, np.nan])
    near = right + np.array([0, 0, 0, 0.45])
    ranges = np.stack([right, one, pair, near, near - np.array([0, 0, 0, 1.0])])
    of = Dive(np.arange(5.0), ranges, np.zeros((5, 3)), np.ones(5, bool), np.zeros((5, 4)))
    result = impossible(of, places)
    assert result[0].tolist() == [False] * 4
    assert result[1].tolist() == [False, True, False, False]
    assert result[2].tolist() == [False] * 4  # one of the two is wrong, but which?
    assert result[3].tolist() == [False] * 4
    assert result[4].tolist() == [False, False, False, True]


def test_logs_that_are_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(tmp_path))
    walks.walks.cache_clear()
    for read in (walks.walks, receivers.dive, robots.landmarks.__wrapped__):
        with pytest.raises(LogError, match="needs these real logs"):
            read()


@pytest.mark.real
def test_walks_have_spikes_and_repeats(real: Path) -> None:
    every = walks.walks()
    assert [walk.name for walk in every] == ["A1", "A2", "B3", "B4"]
    sizes = []
    for walk in every:
        known = walks.surveyed(walk)
        assert 0.05 < known.lag_s < 0.25
        assert 1.0 < known.height_m < 1.3
        assert ((known.sigma > 0.05) & (known.sigma < 0.2)).all()
        case = walks.scenario(walk)
        came = ~np.isnan(case.error)
        assert came.sum() == sum(len(anchor.range) for anchor in walk.anchors.values())
        assert 0.002 < case.wrong[came].mean() < 0.01
        assert np.nanmedian(np.abs(case.error)) < 0.15
        same = [np.mean(np.diff(anchor.range) == 0) for anchor in walk.anchors.values()]
        assert (np.array(same) > 0.03).all()
        assert (np.array(same) < 0.075).all()
        sizes.append(np.nanmax(np.abs(case.error)))
    assert max(sizes) == pytest.approx(45.8, abs=0.3)


@pytest.mark.real
def test_a_walk_with_spikes_told_and_a_position_kept(real: Path) -> None:
    case = walks.scenario(walks.walks()[2])
    numbers = Numbers("E", "uwb_outdoor", "real")
    one = followed_by(case, 0.16, 0.027)
    compared(numbers, FITTED, [replace(one, name=name) for name in ("one", "two")], {"cooperative": 1.0}, 2048)

    def result(metric: str, name: str = "one") -> float:
        return numbers.mean(f"{name} {FITTED}", "cooperative", metric)

    assert result("recall") == 1.0
    assert result("fpr") < 0.005
    assert result("error_p95_m") < 0.7
    assert result("tp", ALL) == 2 * result("tp") == 2 * (case.wrong & case.judged[:, None]).sum()
    assert result("error_p95_m", ALL) == pytest.approx(result("error_p95_m"), rel=1e-2)


@pytest.mark.real
def test_a_dive_places_its_receivers_and_only_doubt_comes_back(real: Path) -> None:
    of = receivers.dive()
    places = receivers.placed(of)
    assert np.linalg.norm(places[:, None] - places, axis=2).max() < 1.2
    case = receivers.scenario(of, places)
    assert np.nanmedian(np.abs(case.error)) < 0.08
    later = ~np.isnan(case.error) & case.judged[:, None]
    wrong = impossible(of, places) & later
    assert wrong.sum() == 19
    one = followed_by(case, 0.06, 0.04)
    refused = {m: through(one.monitors[m], case).flagged for m in ("chi-square-ackf-01", "cooperative")}
    assert refused["cooperative"][later].mean() < 0.1
    assert refused["chi-square-ackf-01"][later].mean() > 2 * refused["cooperative"][later].mean()
    assert refused["cooperative"][wrong].mean() > 0.8


@pytest.mark.real
def test_a_robot_among_its_landmarks(real: Path) -> None:
    own = robots.run(1)
    assert own.sigma_m == pytest.approx(0.105, abs=0.01)
    assert np.nanmax(np.abs(own.case.error)) < 0.6
    one = rovers.watched(1)
    run = through(one.monitors["cooperative"], one.case, ROWS)
    assert np.median(run.off_m[one.case.judged]) < 0.5
    lying = rovers.struck(one, seed=1).case
    assert {fault.kind for fault in lying.faults} == {"frozen", "drift"}
    assert (lying.wrong & ~one.case.wrong).sum() > 50
    learned = ~lying.judged
    np.testing.assert_allclose(lying.error[learned], one.case.error[learned], atol=1e-12)
    found = through(one.monitors["cooperative"], lying, ROWS).flagged[lying.wrong]
    assert found.mean() > 0.5
