"""Condition (d): which satellites of the walk are struck, and how what was refused is counted."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault_studies.wang2023.navigated import Navigated
from sensorfault_studies.wang2023.walk import LASTS_S, ONSETS_S, _alarms, _found, walk


def test_refusals_are_counted_by_whose_they_are() -> None:
    refused = np.zeros((8, 3), bool)
    refused[2:, 1] = True
    refused[5:7, 0] = True
    since = np.arange(8) / 4
    assert _found(refused, 1, since) == {"detection_rate": 0.75, "wrong_exclusions": 0.25, "delay_s": 0.5}
    assert _found(refused, 2, since) == {"detection_rate": 0.0, "wrong_exclusions": 0.75, "delay_s": LASTS_S}


@pytest.mark.real
def test_eight_satellites_are_heard_all_along(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    of = walk()
    assert len(of.names) == 8
    assert {name[0] for name in of.names} == {"G", "E"}
    assert of.epochs.value.shape == (536, 8)
    assert np.isfinite(of.epochs.value).mean() > 0.99
    assert max(ONSETS_S) + LASTS_S < of.epochs.duration_s
    taken = np.isfinite(of.epochs.value)
    blank = np.zeros((536, 3))
    healthy = Navigated(blank, of.epochs.value, of.epochs.value, taken, taken, ~taken, blank[:, 0])
    assert _alarms(of, healthy) == 0.0
    last = healthy._replace(taken=taken & (of.epochs.time < 133.7)[:, None])
    assert _alarms(of, last) == pytest.approx(1 / (of.epochs.time >= 60).sum())
