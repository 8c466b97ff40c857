"""How a score ranks faulty samples above healthy ones, against scikit-learn."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.metrics import average_precision_score, roc_auc_score

from sensorfault.evaluation.ranking import auc, auc_pr

# Few values, so that most scores are tied with others of either class.
SAMPLES = st.lists(st.tuples(st.integers(-3, 3).map(float) | st.floats(-1e3, 1e3), st.booleans()), min_size=2)
BOTH = SAMPLES.filter(lambda samples: len({faulty for _, faulty in samples}) == 2)


def arrays(samples: list[tuple[float, bool]]) -> tuple[np.ndarray, np.ndarray]:
    score, faulty = zip(*samples, strict=True)
    return np.array(score), np.array(faulty)


@given(BOTH)
@settings(deadline=None)
def test_auc_is_scikit_learns(samples: list[tuple[float, bool]]) -> None:
    score, faulty = arrays(samples)
    assert auc(score, faulty) == pytest.approx(roc_auc_score(faulty, score), abs=1e-12)


@given(BOTH)
@settings(deadline=None)
def test_average_precision_is_scikit_learns(samples: list[tuple[float, bool]]) -> None:
    score, faulty = arrays(samples)
    assert auc_pr(score, faulty) == pytest.approx(average_precision_score(faulty, score), abs=1e-12)


@given(BOTH)
@settings(deadline=None)
def test_auc_is_the_chance_of_a_right_order(samples: list[tuple[float, bool]]) -> None:
    score, faulty = arrays(samples)
    pairs = [(p > n) + 0.5 * (p == n) for p in score[faulty] for n in score[~faulty]]
    assert auc(score, faulty) == pytest.approx(np.mean(pairs), abs=1e-12)


@given(BOTH)
@settings(deadline=None)
def test_only_the_order_counts(samples: list[tuple[float, bool]]) -> None:
    score, faulty = arrays(samples)
    rank = np.unique(score, return_inverse=True)[1].astype(float)
    assert auc(score, faulty) == pytest.approx(auc(rank, faulty))
    assert auc(-score, faulty) == pytest.approx(1 - auc(score, faulty))
    assert auc_pr(score, faulty) == pytest.approx(auc_pr(rank, faulty))


def test_perfect_and_useless_scores() -> None:
    faulty = np.array([False] * 90 + [True] * 10)
    assert auc(faulty.astype(float), faulty) == auc_pr(faulty.astype(float), faulty) == 1.0
    assert auc(np.zeros(100), faulty) == 0.5
    assert auc_pr(np.zeros(100), faulty) == pytest.approx(0.1)


def test_a_random_score_gets_no_credit() -> None:
    rng = np.random.default_rng(0)
    faulty = np.zeros(20_000, bool)
    faulty[5000:6000] = faulty[12_000:13_000] = True  # long faults: point adjustment would give nearly all
    score = rng.random(20_000)
    assert auc(score, faulty) == pytest.approx(0.5, abs=0.03)
    assert auc_pr(score, faulty) == pytest.approx(0.1, abs=0.02)


def test_without_both_classes_there_is_no_answer() -> None:
    score = np.arange(3.0)
    assert np.isnan(auc(score, np.ones(3, bool)))
    assert np.isnan(auc(score, np.zeros(3, bool)))
    assert np.isnan(auc_pr(score, np.zeros(3, bool)))
    assert auc_pr(score, np.ones(3, bool)) == 1.0
    assert np.isnan(auc(np.array([]), np.array([], bool)))
