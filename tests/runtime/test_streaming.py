"""A long log, judged part by part: the events are those of the log as a whole."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from sensorfault.logs import Log, LogError, read, write
from sensorfault.logs.epochs import Framing
from sensorfault.logs.readers import csv
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.runtime import streaming
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection
from sensorfault.runtime.streaming import detect_file


def test_the_events_are_those_of_the_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 100_000)
    path = tmp_path / "drive.csv"
    write(fitted.lying().log, path)
    whole = detect(fitted.model(), read(path))
    received: list[float] = []
    seen: list[tuple[Detection, float]] = []
    result = detect_file(fitted.model(), path, tell=received.append, see=lambda part, share: seen.append((part, share)))
    assert len(received) > 5
    assert result.rows == len(whole.log)
    np.testing.assert_allclose(result.log.time, whole.log.time[[0, -1]])
    assert len(result.events) == len(whole.events) > 5
    for mine, theirs in zip(result.events, whole.events, strict=True):
        assert (mine.sensor, mine.channel, mine.kind) == (theirs.sensor, theirs.channel, theirs.kind)
        assert mine.start_s == pytest.approx(theirs.start_s, abs=1e-6)
        assert mine.end_s == pytest.approx(theirs.end_s, abs=1e-6)
        assert mine.peak_score == pytest.approx(theirs.peak_score)
    assert sum(share for _, share in seen) == pytest.approx(1)
    assert max(share for _, share in seen) < 0.5
    assert seen[-1][0].events == result.events
    for name in ("channel", "sensor", "sample", "motion", "repaired"):
        parts = np.concatenate([getattr(part, name) for part, _ in seen])
        np.testing.assert_allclose(parts, getattr(whole, name), atol=1e-9)


def test_without_a_model_one_is_fitted_on_the_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 100_000)
    path = tmp_path / "drive.csv"
    write(fitted.lying().log, path)
    given: list[Log] = []

    def fit(log: Log) -> Model:
        given.append(log)
        return fitted.model()

    whole = read(path)
    shares: list[float] = []
    result = detect_file(fit, path, learn=0.2, see=lambda part, share: shares.append(share))
    assert sum(shares) == pytest.approx(1)
    (early,) = given
    np.testing.assert_array_equal(early.value, whole.value[: len(early)])
    assert result.fitted_on_s[0] == whole.time[0]
    assert early.time[-1] < result.fitted_on_s[1] <= whole.time[len(early)]
    assert 0.1 < len(early) / len(whole) <= 0.2
    np.testing.assert_allclose(result.log.time, whole.time[[len(early), -1]])
    assert result.rows == len(whole) - len(early)
    assert result.events
    monkeypatch.setattr(streaming, "EARLY", 1000)
    detect_file(fit, path, learn=0.9)
    assert given[1].value.size == 1000
    monkeypatch.undo()
    result = detect_file(fit, path, learn=0.3)  # all in one part
    assert len(given[2]) / len(whole) == pytest.approx(0.3, abs=0.01)
    assert result.rows == len(whole) - len(given[2])

    def silent(_path: Path, take: Callable[[Log], None], *_: object) -> ReadingNotes:
        take(whole)
        return ReadingNotes((), ())

    monkeypatch.setattr(streaming, "read_parts", silent)  # a reader that does not tell how far it is
    assert detect_file(fit, path, learn=0.3).rows == result.rows


def test_a_model_of_epochs_is_a_sentence(tmp_path: Path) -> None:
    model = replace(fitted.model(), framing=Framing(("G01",), (), "", False, 1, 1.0, 1.0))
    with pytest.raises(LogError, match=r"epochs of satellites.*read it whole"):
        detect_file(model, tmp_path / "drive.csv")
