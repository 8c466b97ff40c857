"""What is said of a model in sentences."""

from types import SimpleNamespace

from sensorfault.cli import work


def test_the_smallest_step_and_a_gate_that_sleeps() -> None:
    model = SimpleNamespace(summary={"smallest_step_m": {"at once": 23.44, "in 20 s": 12.7}, "inert": "It sleeps."})
    said = "Smallest step found nine times of ten: 23.4 m at once, 12.7 m in 20 s."
    assert work.smallest(model) == (said, "It sleeps.")
    assert work.smallest(SimpleNamespace(summary={})) == ()


def test_of_very_many_channels_the_first_are_said() -> None:
    assert work.watches(["a.x", "a.y"]) == "Watches a.x, a.y."
    assert work.watches([f"s.{i}" for i in range(30)]).endswith("s.23 and 6 more.")
