"""The study of paper E: its missions are what it says, and its numbers are counted right."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.methods.ranging.chi_square_cubature import chi_square
from sensorfault.methods.ranging.cooperative import cooperative
from sensorfault.methods.ranging.range_filter import Filter
from sensorfault_studies.xu2023 import real_auv
from sensorfault_studies.xu2023.contenders import early, eased
from sensorfault_studies.xu2023.run import lockout_s, scores, table, through
from sensorfault_studies.xu2023.scenario import PRINTED, TRAINED_S, scenario

pytestmark = pytest.mark.usefixtures("hasty")


@pytest.fixture(scope="module")
def case():
    return scenario(1001)


def test_a_mission_is_as_the_paper_says(case) -> None:
    came = ~np.isnan(case.error[case.judged])
    assert np.abs(came.sum(axis=0) - [237, 225]).max() < 12
    assert case.wrong[case.judged].sum() == 57
    assert {fault.start_s for fault in PRINTED} <= {fault.start_s for fault in case.faults}
    assert all(fault.duration_s <= 60 for fault in case.faults if fault.start_s >= TRAINED_S and fault.kind == "frozen")
    assert early(case).log.time.max() < TRAINED_S


def test_a_table_is_counted(case) -> None:
    """Against a loop."""
    flagged = np.random.default_rng(0).random(case.error.shape) < 0.3
    want = np.zeros(4)
    for t in range(len(case.log)):
        for j in range(2):
            if case.log.time[t] >= TRAINED_S and np.isfinite(case.error[t, j]):
                wrong = abs(case.error[t, j]) > 9
                want[(0 if wrong else 2) if flagged[t, j] else (3 if wrong else 1)] += 1
    np.testing.assert_array_equal(table(flagged, case), want)


def test_lockout_is_the_longest_wait(case) -> None:
    flagged = (case.log.time > 1000) & (case.log.time < 1100)
    both = np.stack([flagged, flagged], axis=1)
    assert 99 < lockout_s(both, case, 900.0) < 106
    assert lockout_s(~np.isnan(case.error), case, 1600.0) > 90


def test_scores_are_the_papers(case) -> None:
    """Table 2 and figure 16 of the paper: ANFIS."""
    run = through(chi_square("x", early(case).log, 0.01, Filter(0.2)).monitor, case)
    result = scores(np.array([47.0, 401.0, 4.0, 10.0]), run.off_m)
    assert result["accuracy"] == pytest.approx(448 / 462)
    assert result["precision"] == pytest.approx(47 / 51)
    assert result["fpr"] == pytest.approx(4 / 405)
    assert result["fnr"] == pytest.approx(10 / 57)


def test_a_limit_eased_flags_less(case) -> None:
    monitor = chi_square("x", early(case).log, 0.05, Filter(0.2)).monitor
    many, few = (through(eased(monitor, times), case).flagged.sum() for times in (0.7, 2.0))
    assert few < through(monitor, case).flagged.sum() < many
    odds = eqx.tree_at(lambda m: m.branches[0].threshold.limit, monitor, jnp.zeros(3))
    assert (eased(odds, 2.0).branches[0].threshold.limit > 0).all()


def test_ours_is_better_than_the_gate(case) -> None:
    gate = through(chi_square("x", early(case).log, 0.05, Filter(0.2)).monitor, case)
    ours = through(cooperative("x", early(case).log).monitor, case)
    good = [table(run.flagged, case)[:2].sum() for run in (gate, ours)]
    assert good[1] > good[0]
    assert good[1] >= 0.96 * (~np.isnan(case.error[case.judged])).sum()


@pytest.mark.real
def test_real_paths(real_data, monkeypatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    cases = [real_auv.scenario(seed) for seed in (1000, 1001)]
    for case in cases:
        assert case.wrong[case.judged].sum() >= 55
        speed = np.hypot(case.log.value[:, 2], case.log.value[:, 3])
        assert 1.5 < np.nanmean(speed) < 2.5
        ours = through(cooperative("x", early(case).log).monitor, case)
        _, _, fp, _ = four = table(ours.flagged, case)
        assert four[:2].sum() / four.sum() >= 0.95
        assert fp / four[1:3].sum() <= 0.03
