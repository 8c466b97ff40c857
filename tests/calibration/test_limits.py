"""Limits from healthy scores: brute force, and the rules as they are stated."""

import numpy as np
import pytest

import fitted
from sensorfault.calibration import limits
from sensorfault.calibration.limits import LEAST_RUN, repeat_limit, tail_limit

PERIOD_S = 0.02


def runs(same: np.ndarray) -> np.ndarray:
    """Lengths of the current runs of True, by counting."""
    length, result = np.zeros(same.shape[1]), []
    for row in same:
        length = np.where(row, length + 1, 0.0)
        result.append(length)
    return np.array(result)


@pytest.mark.parametrize("p", [0.02, 0.1, 0.3, 0.6])
def test_false_alarms_an_hour_are_at_most_the_designed(p: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Independent repeats of chance p: runs beyond the limit begin at most as often as designed, and not far less.

    The design rate is raised to one that an hour of simulation can count.
    """
    monkeypatch.setattr(limits, "REPEATS_PER_HOUR", 60.0)
    rng = np.random.default_rng(int(100 * p))
    per_hour = round(3600 / PERIOD_S)
    healthy = runs(rng.random((20000, 4)) < p)
    limit = repeat_limit(healthy, PERIOD_S)
    other = runs(rng.random((per_hour // 4, 40)) < p)
    alarms = (other == limit.max() + 1).sum() / 10  # begun runs beyond the limit, in ten hours
    chance = np.ceil(np.log(60 * PERIOD_S / 3600) / np.log(p))
    if limit.max() <= max(chance + 1, LEAST_RUN):  # not the twice-longest rule's doing
        assert alarms > 60 * p**3 * (1 - p) / 2 or limit.max() == LEAST_RUN
    assert alarms <= 60


@pytest.mark.parametrize("p", [0.05, 0.2, 0.4])
def test_the_chance_of_the_stated_rate(p: float) -> None:
    """At n the stated rate p^n / period is at most the designed one, and at n - 1 it is more."""
    count = 1_000_000
    seen = np.zeros((count, 1))
    seen[: round(p * count)] = 1.0  # runs of one: the longest says nothing
    n = float(repeat_limit(seen, PERIOD_S)[0])
    upper = p + 3 / count
    assert upper**n * 3600 / PERIOD_S <= limits.REPEATS_PER_HOUR
    assert upper ** (n - 1) * 3600 / PERIOD_S > limits.REPEATS_PER_HOUR


def test_none_seen_is_not_none_possible() -> None:
    """Rule of three: with no repeat among 300, a chance of a hundredth must still be reckoned with."""
    few, many = (float(repeat_limit(np.zeros((n, 1)), PERIOD_S)[0]) for n in (300, 300_000))
    assert 0.01**few * 3600 / PERIOD_S <= limits.REPEATS_PER_HOUR
    assert few > many == LEAST_RUN


def test_twice_the_longest_healthy_run() -> None:
    """A wheel at rest repeats itself for a minute: two minutes are then still healthy."""
    same = np.zeros((100_000, 2), bool)
    same[5000:8000, 0] = True
    limit = repeat_limit(runs(same), PERIOD_S)
    assert limit[0] == 6000
    assert limit[1] == LEAST_RUN


def test_where_nothing_was_tested_there_is_no_alarm() -> None:
    seen = np.full((100, 3), np.nan)
    seen[:, 1] = 0.0
    seen[::5, 2] = 2.0
    limit = repeat_limit(seen, PERIOD_S)
    assert limit[0] == np.inf
    assert np.isfinite(limit[1:]).all()


def test_always_repeating_does_not_overflow() -> None:
    limit = repeat_limit(runs(np.ones((500, 1), bool)), PERIOD_S)
    assert np.isfinite(limit).all()
    assert limit[0] >= 1000


@pytest.mark.parametrize("method", ["elm-autoencoder", "pca"])
def test_the_limit_is_the_largest_training_error(method: str) -> None:
    """Equation (10), from the fitted weights and the training rows alone."""
    monitor = fitted.model(method).monitor
    net = monitor.residual
    w, b, out, offset, center, half = (
        np.asarray(x) for x in (net.weights, net.bias, net.output, net.offset, net.center, net.half)
    )
    value = fitted.rig().between(end_s=fitted.LEARN_S).value[:, :6]
    x = (value - center[:6]) / half[:6]
    hidden = x @ w[:, :6].T + b
    hidden = 1 / (1 + np.exp(-hidden)) if method == "elm-autoencoder" else hidden
    error = np.linalg.norm(x - (hidden @ out[:6].T + offset[:6]), axis=1)
    largest = float(monitor.branches[0].threshold.largest[0])
    assert largest == pytest.approx(error.max(), rel=1e-9)


def test_repeats_are_limited_channel_by_channel() -> None:
    model = fitted.model()
    limit = np.asarray(model.monitor.branches[1].threshold.limit)
    np.testing.assert_array_equal(limit[:6], np.full(6, LEAST_RUN))  # white noise never repeats itself
    np.testing.assert_array_equal(limit[6:], np.full(2, np.inf))  # a fix is not watched


def exponential(hours: float, seed: int, scale: float = 2.0) -> np.ndarray:
    """Independent scores at 2 Hz."""
    return scale * np.random.default_rng(seed).standard_exponential((round(hours * 7200), 1))


def test_a_tail_is_extrapolated_to_the_rate_that_was_asked_for() -> None:
    """Of ten minutes each: one exceedance an hour of 7200 is passed at scale log(7200)."""
    limits = [float(tail_limit(exponential(1 / 6, seed), 0.5, 1.0)[0]) for seed in range(40)]
    assert np.median(limits) == pytest.approx(2.0 * np.log(7200), rel=0.1)
    unseen = exponential(50.0, 99)
    rates = [float((unseen > limit).sum()) / 50.0 for limit in limits]
    assert 0.3 < np.median(rates) < 3.0


def test_a_tail_limit_stands_above_all_that_was_seen_and_scales_with_it() -> None:
    scores = exponential(0.1, 3)
    limit = tail_limit(scores, 0.5, 1.0)
    assert limit[0] > scores.max()
    np.testing.assert_allclose(tail_limit(1000 * scores, 0.5, 1.0), 1000 * limit)
    assert (tail_limit(scores, 0.5, 0.1) > limit).all()


def test_a_heavy_tail_is_taken_for_one_where_much_was_seen() -> None:
    heavy = np.random.default_rng(0).pareto(3.0, (7200 * 5, 1))
    # 0.1 an hour of 7200: x = 72000^(1/3) - 1 = 40.6; an exponential tail ends at the largest seen, 22.6
    assert 1.2 * heavy.max() < tail_limit(heavy, 0.5, 0.1)[0] < 60.0


def test_scores_that_come_seldom_are_extrapolated_over_the_same_time() -> None:
    scores = exponential(1.0, 5)
    held = np.full((5 * len(scores), 1), np.nan)
    held[::5] = scores
    np.testing.assert_allclose(tail_limit(held, 0.1, 1.0), tail_limit(scores, 0.5, 1.0), rtol=0.05)


def test_a_test_that_never_ran_has_no_limit() -> None:
    scores = np.full((100, 2), np.nan)
    scores[:3, 1] = 1.0, 2.0, 3.0
    silent, few = tail_limit(scores, 0.1, 1.0)
    assert silent == np.inf
    assert few >= 3.0
