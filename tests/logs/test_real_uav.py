"""Facts of real flights: topics of an autopilot, a MATLAB structure, DataFlash."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import VehicleFile, guess, read
from sensorfault.logs.table import Log
from sensorfault_studies.multistep.flights import flight

pytestmark = pytest.mark.real


def news(log: Log, path: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of a channel's measurements."""
    i = log.index(path)
    fresh = log.fresh[:, i]
    return log.time[fresh], log.value[fresh, i]


@pytest.fixture(autouse=True)
def _here(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))


def test_proto() -> None:
    log = flight("proto")
    time, height = news(log, "gnss.altitude")
    assert len(height) == 2622
    assert 1 / np.median(np.diff(time)) == pytest.approx(5.0, abs=0.1)
    assert height[[0, -1]] == pytest.approx([278.1, 276.7], abs=1.0)
    assert news(log, "barometer.altitude")[1][0] == pytest.approx(203.7, abs=0.5)
    assert 1 / np.median(np.diff(news(log, "barometer.altitude")[0])) == pytest.approx(9.9, abs=0.2)
    # the nose points where the path rises, give or take the angle of attack
    pitch, down = news(log, "attitude.pitch"), news(log, "gnss.down")
    at = (down[0] > 150) & (down[0] < 300)
    assert np.corrcoef(np.interp(down[0], *pitch)[at], -down[1][at])[0, 1] > 0.6


def test_thor() -> None:
    log = flight("thor")
    assert log.duration_s == pytest.approx(674.2, abs=0.1)
    assert log.period_s == pytest.approx(0.02, abs=1e-4)
    time, height = news(log, "gnss.altitude")
    assert np.median(np.diff(time)) == pytest.approx(1.0, abs=0.01)
    assert height.min() > 240
    assert news(log, "accelerometer.z")[1].mean() == pytest.approx(-10.2, abs=0.1)  # turning, most of the time


@pytest.mark.parametrize(("name", "seconds", "first"), [("jd_200424", 332.5, 297.88), ("jd_204405", 301.0, 291.9)])
def test_dataflash_copters(real_data: Path, name: str, seconds: float, first: float) -> None:
    path = real_data / "uav" / "copter_jd2014" / f"{name}.bin"
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(seconds, abs=0.2)
    assert log.period_s == pytest.approx(0.02, abs=1e-3)
    time, height = news(log, "gnss.altitude")
    assert height[0] == pytest.approx(first, abs=0.01)
    assert np.median(np.diff(time)) == pytest.approx(0.2, abs=0.01)
    barometer = news(log, "barometer.altitude")
    # both say the same climb
    assert np.std(height - np.interp(time, *barometer)) < 0.2 * np.std(height)
    assert np.abs(news(log, "attitude.roll")[1]).max() < 1.0
