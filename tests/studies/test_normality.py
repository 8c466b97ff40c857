"""A3: the parts on simulated numbers; on the real drives, the expected results."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from sensorfault_studies.findings import Row
from sensorfault_studies.min2021 import normality as study
from sensorfault_studies.min2021.normality_faults import biases, motions
from sensorfault_studies.min2021.normality_sizes import jarque_bera, simulated, sizes, windows


def number(rows: list[Row], **wanted: object) -> float:
    (value,) = [r.value for r in rows if all(getattr(r, key) == want for key, want in wanted.items())]
    return value


def test_jarque_bera_is_scipys() -> None:
    x = np.random.default_rng(0).gamma(2.0, size=(5, 80))
    np.testing.assert_allclose(jarque_bera(x), stats.jarque_bera(x, axis=1).statistic, rtol=1e-10)


def test_windows() -> None:
    signal = np.where(np.arange(300) % 3 == 0, np.arange(300.0), np.nan)
    parts = windows(signal, np.arange(300) / 10, 2)
    assert [len(part) for part in parts] == [17, 17, 16]
    np.testing.assert_array_equal(parts[0][:3], [0.0, 6.0, 12.0])


def test_on_numbers_made_for_it() -> None:
    """Must: AR(.9) Gaussian at least .35 undecimated, at most .08 decimated x10; blind to bias and scale."""
    rows = list(simulated(2))
    assert number(rows, condition="ar0.9", metric="far") >= 0.35
    assert number(rows, condition="ar0.9 x10", metric="far") <= 0.08
    size = number(rows, condition="whole-window", fault=None)
    for fault in ("offset", "scale"):
        assert number(rows, fault=fault, method="jarque-bera") == pytest.approx(size, abs=1e-3)
    assert number(rows, fault="offset", method="mean") > 0.99
    assert number(rows, fault="scale", method="variance") > 0.99


@cache
def drive(data: str):
    return study.judged(data)


@pytest.mark.real
@pytest.mark.parametrize("data", ["dresden_50hz", "drive0708"])
def test_a_bias_of_two_metres_is_found(data: str, real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    rows = biases(drive(data), 20, (2.0,))
    assert number(rows, condition="length instant", fault="offset", metric="detection_rate") >= 0.95
    assert number(rows, condition="length instant", metric="far") <= 1e-3
    assert number(rows, condition="length instant", metric="chance") <= 0.1


@pytest.mark.real
def test_motions_are_told_as_motions(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    rows = motions(drive("drive0708"), [], 3)
    for fault, size in (("side-slip-2s", 1.0), ("side-slip-10s", 1.5), ("spin-2s", 1.0)):
        assert number(rows, fault=fault, magnitude=size, metric="detection_rate") >= 0.6
        assert number(rows, fault=fault, magnitude=size, metric="wrong_exclusions") == 0


@pytest.mark.real
@pytest.mark.parametrize("data", ["dresden_50hz", "drive0708"])
def test_a_slide_is_felt_whatever_the_receiver_is_late_by(
    data: str, real_data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    rows = [row for row in motions(study.judged(data, "side-force"), [], 6) if row.fault == "side-slip-2s"]
    assert number(rows, magnitude=2.0, metric="detection_rate") == 1
    assert {row.value for row in rows if row.metric in ("wrong_exclusions", "chance")} == {0}


@pytest.mark.real
def test_healthy_innovations_are_about_as_wide_as_claimed(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    rows = study._spreads(drive("drive0708"))
    wide = [r.value for r in rows if r.metric == "innovation_sd"]
    assert min(wide) > 0.8
    assert max(wide) < 1.15


@pytest.mark.real
def test_the_test_rejects_what_is_healthy_unless_decimated(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    one = drive("dresden_50hz")
    rows, _ = sizes("dresden_50hz", study._whole(one), one.filter)
    far = {r.condition: r.value for r in rows if r.metric == "far"}
    assert far["every-tick"] > 0.8
    assert far["every-tick"] > far["epochs"] > far["epochs x5"] >= far["epochs x10"]
