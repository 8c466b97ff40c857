"""The predictors of the position against plain NumPy, and where longitudes end."""

import re
from dataclasses import replace
from functools import cache, partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.linalg

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position import ar_predictor, linear_extrapolation, lstm_predictor, persistence
from sensorfault.methods.position.positions import GAP
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.simulation.road import drive
from sensorfault.stages.residual.prediction import Prediction
from sensorfault.training.gradient import Plan
from sensorfault.training.session import SILENT

LENGTH = 8
SEEN = ("gnss.latitude", "gnss.longitude", *(f"{s}.{a}" for s in ("gyro", "accelerometer") for a in "xyz"))
METHODS = {
    "ar-predictor": partial(ar_predictor.build, length=LENGTH),
    "persistence": persistence.build,
    "linear-extrapolation": linear_extrapolation.build,
    "lstm-predictor": partial(
        lstm_predictor.build, size=lstm_predictor.Size(LENGTH, (4,), Plan(epochs=3, batch=128, rate=0.01))
    ),
}


@cache
def log(latitude_deg: float = 51.05, longitude_deg: float = 13.74) -> Log:
    return drive(60.0, seed=3, origin_deg=(latitude_deg, longitude_deg, 100.0)).log


@cache
def model(method: str, latitude_deg: float = 51.05, longitude_deg: float = 13.74) -> Model:
    return METHODS[method](log(latitude_deg, longitude_deg), 0, SILENT)


def columns() -> list[int]:
    return [log().index(path) for path in SEEN]


def scaled(result: Log, like: Log) -> np.ndarray:
    """What each channel held at each tick, mapped to [-1, 1] by the extremes of `like`."""
    held = np.full((len(result), 8), np.nan)
    for v, c in enumerate(columns()):
        seen = like.value[like.fresh[:, c], c]
        low, high = seen.min(), seen.max()
        last = (low + high) / 2
        for k in range(len(result)):
            if result.fresh[k, c]:
                last = result.value[k, c]
            held[k, v] = 2 * (last - low) / (high - low) - 1
    return held


def windows(result: Log, like: Log) -> tuple[np.ndarray, np.ndarray]:
    """The ticks with a fix and enough before them, and their windows, flat."""
    held = scaled(result, like)
    ticks = [k for k in range(LENGTH, len(result)) if result.fresh[k, columns()[0]]]
    return np.array(ticks), np.array([held[k - LENGTH : k].ravel() for k in ticks])


def test_the_autoregression_is_least_squares() -> None:
    fitted = model("ar-predictor")
    residual = fitted.monitor.residual
    assert isinstance(residual, Prediction)
    assert residual.inputs == tuple(columns())
    ticks, x = windows(log(), log())
    whole = replay_log(uncalibrated(fitted.monitor), log()).valid[ticks, columns()[0]]
    assert whole.mean() > 0.95
    ticks, x = ticks[whole], np.column_stack([x, np.ones(len(x))])[whole]
    y = scaled(log(), log())[ticks][:, :2]
    best = y - x @ scipy.linalg.lstsq(x, y)[0]
    dense = residual.network.output
    left = y - x @ np.vstack([np.asarray(dense.weights).T, np.asarray(dense.bias)])
    np.testing.assert_allclose(left, best, rtol=0, atol=1e-8)
    largest = fitted.monitor.branches[0].threshold.largest
    np.testing.assert_allclose(largest, np.linalg.norm(best, axis=1).max(), rtol=1e-6)


@pytest.mark.parametrize("method", ["ar-predictor", "lstm-predictor"])
def test_a_prediction_is_made_from_the_window_before(method: str) -> None:
    """Live windows, one after the other, are the rows before: with a gap in the clock and a spell without fixes."""
    fitted = model(method)
    value, fresh, time = log().value.copy(), log().fresh.copy(), log().time.copy()
    fix = list(columns()[:2])
    value[1200:1300, fix], fresh[1200:1300, fix] = np.nan, False
    value[700:720, columns()[3]] = np.nan
    fresh[700:720, columns()[3]] = False
    time[2000:] += 20 * log().period_s
    broken = replace(log(), value=value, fresh=fresh, time=time)
    result = replay_log(uncalibrated(fitted.monitor), broken)
    ticks, x = windows(broken, log())
    net = jax.jit(fitted.monitor.residual.network.__call__)
    low, high = (getattr(log().value[log().fresh[:, fix[0]]][:, fix], f)(axis=0) for f in ("min", "max"))
    tested = np.flatnonzero(result.valid[:, fix[0]])
    assert (result.valid[:, fix[0]] == result.valid[:, fix[1]]).all()
    assert not result.valid[:, [c for c in range(len(log().channels)) if c not in fix]].any()
    for k in tested[::40]:
        row = x[np.flatnonzero(ticks == k)[0]].reshape(LENGTH, 8)
        want = broken.value[k, fix] - (low + (np.asarray(net(jnp.asarray(row))) + 1) / 2 * (high - low))
        np.testing.assert_allclose(result.residual[k, fix], want, rtol=1e-7, atol=1e-13)
    # unknown until the window is full again: from the first fix after the start, the spell and the gap in the clock
    for start in (0, 1300, 2000):
        first = start + int(np.flatnonzero(fresh[start:, fix[0]])[0])
        again = tested[tested >= start][0]
        assert first + LENGTH <= again < first + LENGTH + 5
    assert not result.valid[1200:1300].any()
    assert np.isin(ticks[(ticks > 10) & (ticks < 1200)], tested).mean() > 0.99


@pytest.mark.parametrize("order", [0, 1])
def test_an_extrapolation_goes_through_the_last_fixes(order: int) -> None:
    fitted = model("linear-extrapolation" if order else "persistence")
    result = replay_log(uncalibrated(fitted.monitor), log())
    c = columns()[1]
    ticks = np.flatnonzero(log().fresh[:, c])
    y, t = log().value[ticks, c], log().time[ticks]
    want = y[2:] - y[1:-1]
    if order:
        want = want - (y[1:-1] - y[:-2]) / (t[1:-1] - t[:-2]) * (t[2:] - t[1:-1])
    tested = result.valid[ticks[2:], c]
    # not after a spell without fixes, of which this drive has one or two
    assert 0.97 < tested.mean() <= 1
    assert not np.delete(result.valid[:, c], ticks[1:]).any()
    np.testing.assert_allclose(result.residual[ticks[2:], c][tested], want[tested], rtol=1e-9, atol=1e-14)


@pytest.mark.parametrize("method", METHODS)
def test_the_date_line_is_a_place_like_any_other(method: str) -> None:
    """The same drive across it: nothing is accused, and residuals are what they are elsewhere."""
    longitude = columns()[1]
    there = log(51.05, 180.0)
    assert np.ptp(there.value[:, longitude]) > 6, "it never crosses"
    fitted = model(method, 51.05, 180.0)
    assert detect(fitted, there).events == ()
    result = replay_log(uncalibrated(fitted.monitor), there)
    assert np.abs(result.residual[result.valid]).max() < 1e-3
    if method != "lstm-predictor":
        same = replay_log(uncalibrated(model(method).monitor), log())
        np.testing.assert_array_equal(result.valid, same.valid)
        np.testing.assert_allclose(result.residual, same.residual, atol=2e-9)


@pytest.mark.parametrize("method", METHODS)
def test_at_the_pole_nothing_is_poisoned(method: str) -> None:
    """Longitudes turn all the way round; what was healthy there is healthy, and a fault elsewhere is still found."""
    there = log(89.9999, 0.0)
    fitted = model(method, 89.9999, 0.0)
    found = detect(fitted, there)
    assert found.events == ()
    assert np.isfinite(found.repaired[:, columns()[:2]]).all()


@pytest.mark.parametrize("method", METHODS)
def test_a_jump_of_the_position_is_found(method: str) -> None:
    value = log().value.copy()
    value[1500:, columns()[0]] += 0.001
    events = detect(model(method), replace(log(), value=value)).events
    first = log().time[1500:][log().fresh[1500:, columns()[0]]][0]
    assert events
    assert events[0].sensor == "gnss"
    assert events[0].start_s == first


@pytest.mark.parametrize("method", METHODS)
def test_what_cannot_be_predicted_is_said(method: str) -> None:
    def sentence(bad: Log) -> str:
        with pytest.raises(LogError) as raised:
            METHODS[method](bad, 0, SILENT)
        text = str(raised.value)
        assert text.endswith(".")
        assert "\n" not in text
        return text

    imu = log().select(SEEN[2:])
    assert f"has no latitude, longitude, which {method} predicts" in sentence(imu)
    assert "positions" in sentence(log().between(end_s=2.0))
    value = log().value.copy()
    value[:, columns()[:2]] = value[0, columns()[:2]]
    assert "never moves" in sentence(replace(log(), value=value))
    if method in ("ar-predictor", "lstm-predictor"):
        holes = log().time + np.arange(len(log())) // LENGTH * 10 * GAP * log().period_s
        assert re.search("window|without a gap", sentence(replace(log(), time=holes)))


def test_without_an_inertial_unit_the_position_is_predicted_from_itself() -> None:
    alone = log().select(SEEN[:2])
    fitted = METHODS["ar-predictor"](alone, 0, SILENT)
    assert fitted.summary["inputs"] == list(SEEN[:2])
    assert fitted.watched == (True, True)
