"""The drive under lying satellites: what is injected, how it is counted, and that the filter is right about itself."""

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.core.monitor import Branch
from sensorfault.methods.gnss.gnss_ins import Filter, navigation
from sensorfault.methods.gnss.gnss_ins import monitor as watching
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault_studies.wang2023.campaign import SETTLED, Flown, case, false_alarms, flown
from sensorfault_studies.wang2023.contenders import without_exclusion
from sensorfault_studies.wang2023.drive import pseudoranges
from sensorfault_studies.wang2023.matching import limited, matched
from sensorfault_studies.wang2023.trials import LASTS, ONSETS, SatelliteFault, outcome, trials


def test_every_satellite_lies_from_every_onset() -> None:
    error = np.zeros((2, 413, 3))
    every = trials(error, SatelliteFault("ramp", 0.5))
    assert every.shape == (2 * len(ONSETS) * 3, 413, 3)
    for m, wrong in enumerate(every):
        onset, satellite = ONSETS[m // 3 % len(ONSETS)], m % 3
        assert np.flatnonzero(wrong.any(axis=0)).tolist() == [satellite]
        assert wrong[onset + 10, satellite] == 5.0
        assert wrong[onset + LASTS - 1, satellite] == 0.5 * (LASTS - 1)
        assert not wrong[onset + LASTS :].any()


def test_an_outcome_counts_the_right_satellite_its_delay_and_the_wrong_ones() -> None:
    trial = len(ONSETS) * 2
    flagged = np.zeros((trial, 413, 2), bool)
    for m in range(trial):
        onset, satellite = ONSETS[m // 2], m % 2
        flagged[m, onset + 20 : onset + LASTS, satellite] = True
        flagged[m, onset : onset + 8, 1 - satellite] = True
        flagged[m, :onset] = True  # before the fault nothing counts
    off = np.full((trial, 413), 3.0)
    nothing = np.full((trial, 413, 2), np.nan)
    (result,) = outcome(Flown(flagged, off, off, nothing, nothing), 1)
    expected = {"detection_rate": 0.75, "delay_s": 20.0, "wrong_exclusions": 0.1, "hrmse_m": 3.0}
    assert result == pytest.approx(expected)
    (never,) = outcome(Flown(flagged & False, off, off, nothing, nothing), 1)
    assert never["delay_s"] == LASTS


@pytest.fixture
def _data(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))


@pytest.mark.real
@pytest.mark.usefixtures("_data")
def test_on_gaussian_noise_innovations_are_as_large_as_the_filter_says() -> None:
    of = case()
    result = flown(without_exclusion(of, 1.0), of, pseudoranges("gaussian", range(70, 82)))
    each = result.normalised[:, SETTLED:].std(axis=(1, 2))
    assert (each > 0.9).all()
    assert (each < 1.1).all()
    # two metres on the level where a single epoch knows three
    assert np.sqrt(np.mean(result.off_m[:, SETTLED:] ** 2)) < 2.0


@pytest.mark.real
@pytest.mark.usefixtures("_data")
def test_a_limit_is_set_by_the_rate_that_it_achieves_and_finds_a_large_step_at_once() -> None:
    of = case()
    free = watching(of.framing, navigation(of.framing, Filter()), Branch(Normalised(), Fixed(jnp.inf * jnp.ones(9))))
    monitor, limit, reached = matched(free, of, pseudoranges("heavy", range(100, 124)), 0.02)
    assert 0.01 < reached < 0.04
    assert 2.5 < limit.low <= limit.limit <= limit.high < 6.0
    assert false_alarms(flown(limited(monitor, np.inf), of, pseudoranges("heavy", [1]))) == 0.0
    (result,) = outcome(flown(monitor, of, trials(pseudoranges("heavy", [2]), SatelliteFault("step", 30.0))), 1)
    assert result["detection_rate"] > 0.97
    assert result["delay_s"] < 1.0
