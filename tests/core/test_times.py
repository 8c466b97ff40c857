"""Times as people read them."""

import math

import pytest

from sensorfault.core.times import clock


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        *((0.0, "0:00.00"), (9.994, "0:09.99"), (102.3, "1:42.30")),
        *((59.994, "0:59.99"), (59.999, "1:00.00"), (3599.999, "1:00:00.00")),  # rounded up, never 0:60.00
        *((4500.0, "1:15:00.00"), (3725.5, "1:02:05.50"), (360_000.0, "100:00:00.00")),
        *((-49.65, "-0:49.65"), (-1.0, "-0:01.00"), (-3600.0, "-1:00:00.00"), (-59.999, "-1:00.00")),
        *((-0.001, "0:00.00"), (-0.0, "0:00.00")),
        *((math.nan, "unknown"), (math.inf, "unknown"), (-math.inf, "unknown")),
    ],
)
def test_clock(seconds: float, text: str) -> None:
    assert clock(seconds) == text
