"""Sentences about a model and its limits."""

from types import SimpleNamespace

import pytest

from sensorfault.cli import limits


def test_the_smallest_step_and_a_warning() -> None:
    model = SimpleNamespace(summary={"smallest_step_m": {"at once": 23.44, "in 20 s": 12.7}, "inert": "It is blind."})
    sentence = "Smallest step found nine times out of ten: 23.4 m at once, 12.7 m in 20 s."
    assert limits.smallest(model) == (sentence, "It is blind.")
    assert limits.smallest(SimpleNamespace(summary={})) == ()


def test_of_very_many_channels_the_first_are_named() -> None:
    assert limits.watches(["a.x", "a.y"]) == "Watches a.x, a.y."
    assert limits.watches([f"s.{i}" for i in range(30)]).endswith("s.23 and 6 more.")


@pytest.mark.parametrize(
    ("count", "seconds", "sentence"),
    [
        (0, 65.0, "none in 65 s: too short to promise a rate"),
        (0, 3599.0, "none in 60.0 min: too short to promise a rate"),
        (0, 36000.0, "none in 10.0 h: fewer than 0.297 an hour with 95 % confidence"),
        (2, 360.0, "2 in 6.0 min, 20 an hour (fewer than 62.8 an hour with 95 % confidence)"),
        (0, 0.0, "none in 0 s: too short to promise a rate"),
        (3, 0.0, "3"),
    ],
)
def test_what_a_count_of_false_alarms_proves(count: int, seconds: float, sentence: str) -> None:
    assert limits.alarms(count, seconds) == sentence


def test_the_rate_of_a_model() -> None:
    assert limits.rate(SimpleNamespace(summary={})) == ("False-alarm rate: not measured.",)
    known = {"alarms_per_hour": 0.0, "alarms_per_hour_below": 165.0, "held_out_alarms": 0, "held_out_s": 65.0}
    sentence = "False alarms on the part held out: none in 65 s: too short to promise a rate."
    assert limits.rate(SimpleNamespace(summary=known)) == (sentence,)


def test_channels_with_the_same_reason_share_a_sentence() -> None:
    reasons = {"gnss.east": "a position", "gnss.north": "a position", "wheel.speed": "too slow"}
    model = SimpleNamespace(summary={"not_watched": reasons, "cannot": {"height": "no barometer."}})
    assert limits.not_watched(model) == (
        "Not running height: no barometer.",
        "Checked for dropouts only: gnss.east, gnss.north (a position); wheel.speed (too slow).",
    )
