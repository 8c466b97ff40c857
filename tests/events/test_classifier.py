"""Residuals of every kind, named; those that do not tell, not named."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sensorfault.events.classifier import FaultClassifier

PERIOD_S = 0.02
SIGMA = 0.1
SEEDS = st.integers(0, 10_000)
SIGNS = st.sampled_from([-1.0, 1.0])


def kind(residual: np.ndarray, measured: np.ndarray | None = None, start_s: float = 50.0, chunk: int = 7) -> str:
    """The kind of a residual that came in a few rows at a time; the measurements never repeat unless given."""
    measured = 3.0 + 1e-3 * np.arange(len(residual)) + residual if measured is None else measured
    classifier = FaultClassifier()
    rows = [
        (start_s + i * PERIOD_S, float(m), float(r)) for i, (m, r) in enumerate(zip(measured, residual, strict=True))
    ]
    for i in range(0, len(rows), chunk):
        classifier.take(rows[i : i + chunk])
    return classifier.kind(PERIOD_S, SIGMA)


def noise(rng: np.random.Generator, n: int) -> np.ndarray:
    return rng.normal(0, SIGMA, n)


@given(st.floats(5, 1e4), SIGNS, st.integers(1, 2))
@settings(deadline=None)
def test_short(size: float, sign: float, n: int) -> None:
    assert kind(np.full(n, sign * size * SIGMA)) == "spike"


@given(SEEDS, st.floats(5, 1000), SIGNS, st.integers(10, 500))
@settings(max_examples=60, deadline=None)
def test_bias(seed: int, size: float, sign: float, n: int) -> None:
    rng = np.random.default_rng(seed)
    assert kind(sign * size * SIGMA + noise(rng, n)) == "offset"


@given(SEEDS, st.floats(20, 1000), SIGNS, st.integers(50, 500))
@settings(max_examples=60, deadline=None)
def test_drift(seed: int, size: float, sign: float, n: int) -> None:
    """A ramp from nothing to many sigmas."""
    rng = np.random.default_rng(seed)
    assert kind(sign * np.linspace(0, size * SIGMA, n) + noise(rng, n)) == "drift"


@given(SEEDS, st.integers(4, 500), st.floats(-5, 5))
@settings(max_examples=60, deadline=None)
def test_jam(seed: int, n: int, at: float) -> None:
    """The measurement stands while what is expected moves on."""
    rng = np.random.default_rng(seed)
    assert kind(at - np.sin(np.arange(n) / 10) + noise(rng, n), np.full(n, at)) == "frozen"


@given(SEEDS, st.floats(3, 1000), st.integers(100, 500))
@settings(max_examples=60, deadline=None)
def test_noise(seed: int, size: float, n: int) -> None:
    """White, many times the healthy spread, of no clear mean: a chance mean of three standard errors is left out."""
    rng = np.random.default_rng(seed)
    white = size * noise(rng, n)
    white -= white.mean()
    slope = np.polyfit(np.arange(n), white, 1)
    assert kind(white - np.polyval(slope, np.arange(n))) == "noise"


@pytest.mark.parametrize("size", [5.0, 30.0])
def test_noise_is_hardly_ever_called_anything_else(size: float) -> None:
    rng = np.random.default_rng(int(size))
    said = [kind(size * noise(rng, 200)) for _ in range(300)]
    assert said.count("noise") > 0.98 * len(said)


@given(SEEDS, st.integers(10, 500))
@settings(max_examples=60, deadline=None)
def test_what_looks_healthy_is_unknown(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    calm = noise(rng, n)
    line = np.polyfit(np.arange(n), calm, 1)
    assert kind(calm - np.polyval(line, np.arange(n))) == "unknown"


def test_nothing_measured_is_unknown() -> None:
    assert FaultClassifier().kind(PERIOD_S, SIGMA) == "unknown"
    classifier = FaultClassifier()
    classifier.take([])
    assert classifier.kind(PERIOD_S, SIGMA) == "unknown"


@given(SEEDS, st.integers(3, 50), st.integers(1, 40))
@settings(max_examples=40, deadline=None)
def test_in_how_many_parts_it_comes_does_not_matter(seed: int, n: int, chunk: int) -> None:
    rng = np.random.default_rng(seed)
    residual = rng.normal(rng.uniform(-1, 1), rng.uniform(0, 1), n)
    measured = rng.integers(0, 3, n).astype(float)
    assert kind(residual, measured, chunk=chunk) == kind(residual, measured, chunk=1)


@given(SEEDS, st.sampled_from(["offset", "drift", "noise"]), st.sampled_from([1e3, 1e6, 1.8e9]))
@settings(max_examples=40, deadline=None)
def test_when_it_happens_does_not_matter(seed: int, what: str, start_s: float) -> None:
    """The sums run from the event's own start: in Unix time the same residual has the same name."""
    rng = np.random.default_rng(seed)
    n = 200
    residual = (
        noise(rng, n) + {"offset": np.full(n, 2.0), "drift": np.linspace(0, 9, n), "noise": 30 * noise(rng, n)}[what]
    )
    assert kind(residual, start_s=start_s) == kind(residual, start_s=0.0)


@given(SEEDS, st.floats(1e-6, 1e6))
@settings(max_examples=40, deadline=None)
def test_the_unit_does_not_matter(seed: int, unit: float) -> None:
    rng = np.random.default_rng(seed)
    residual = (
        rng.uniform(0, 10) * SIGMA + np.linspace(0, rng.uniform(0, 10), 100) + rng.uniform(0, 5) * noise(rng, 100)
    )
    rows = [(i * PERIOD_S, float(i), float(r)) for i, r in enumerate(residual)]
    one, two = FaultClassifier(), FaultClassifier()
    one.take(rows)
    two.take([(t, m, r * unit) for t, m, r in rows])
    assert one.kind(PERIOD_S, SIGMA) == two.kind(PERIOD_S, SIGMA * unit)
