"""The one type of result: of a log judged whole with all rows, of a log judged in parts with its first and its last."""

import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from sensorfault.evaluation.judge import judge
from sensorfault.logs import Log, LogError, write
from sensorfault.logs.readers import csv
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.runtime.detector import Detector
from sensorfault.runtime.result import PER_ROW, Detection, RowsNotKept
from sensorfault.runtime.streaming import detect_file, detect_parts


def in_parts(*cuts_s: float) -> Detection:
    detector = Detector(fitted.model())
    for start, end in zip((-np.inf, *cuts_s), (*cuts_s, np.inf), strict=True):
        detector.take(fitted.lying().log.between(start, end))
    return detector.found(ReadingNotes(("The file breaks off.", "Guessed."), ("The file breaks off.",)), (0.0, 100.0))


def same(one: Detection, two: Detection) -> None:
    for name in ("channel", "sensor", "sample", "motion", "repaired"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    assert one.events == two.events
    assert (one.rows, one.whole, one.period_s) == (two.rows, two.whole, two.period_s)


def test_a_log_of_one_part_is_a_whole_log() -> None:
    detection, whole = in_parts(), fitted.found()
    same(detection, whole)
    assert detection.whole
    assert detection.rows == len(detection.log) == len(fitted.lying().log)
    assert detection.notes == ("The file breaks off.", "Guessed.", *whole.notes)
    assert detection.log.damage == ("The file breaks off.",)
    assert detection.fitted_on_s == (0.0, 100.0)
    assert detection.model is fitted.model()
    assert (whole.model, whole.fitted_on_s) == (fitted.model(), None)


def test_of_a_log_in_parts_the_rows_that_are_not_kept_are_a_sentence() -> None:
    detection, whole = in_parts(120.0, 121.0), fitted.found()
    assert detection.events == whole.events
    assert detection.rows == whole.rows > 2
    np.testing.assert_array_equal(detection.log.time, whole.log.time[[0, -1]])
    assert detection.notes == ("The file breaks off.", "Guessed.", *whole.notes)
    assert not detection.whole
    assert detection.period_s == pytest.approx(whole.period_s) == pytest.approx(1 / fitted.HZ)
    assert len(PER_ROW) == 6
    for name in PER_ROW:
        assert not hasattr(detection, name)
        with pytest.raises(RowsNotKept, match=f"was judged in parts and its rows were not kept.* no '{name}';"):
            getattr(detection, name)
    with pytest.raises(LogError, match="read the log whole"):
        replace(detection, method="another")
    with pytest.raises(AttributeError, match="Detection has no 'chanel'"):
        _ = detection.chanel  # type: ignore[attr-defined]
    assert copy.copy(detection).events == detection.events


def test_events_of_a_log_in_parts_are_judged_as_those_of_the_whole() -> None:
    truth = fitted.lying().truth
    parts, whole = judge(in_parts(130.0), truth), judge(fitted.found(), truth)
    assert [outcome.found for outcome in parts.outcomes] == [outcome.found for outcome in whole.outcomes]
    assert parts.false_alarms == whole.false_alarms
    assert parts.healthy_hours == pytest.approx(whole.healthy_hours)


def test_a_small_file_in_one_part_keeps_its_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drive.csv"
    write(fitted.lying().log, path)
    assert detect_file(fitted.model(), path).whole
    monkeypatch.setattr(csv, "_PART_BYTES", 100_000)
    assert not detect_file(fitted.model(), path).whole


def test_a_whole_log_is_fitted_on_its_beginning_and_judged_on_the_rest() -> None:
    log, given = fitted.lying().log, list[Log]()
    done, shares = list[float](), list[float]()

    def fit(early: Log):
        given.append(early)
        return fitted.model()

    def parts(take, tell) -> ReadingNotes:
        take(log)
        return ReadingNotes(log.notes, log.damage)

    see = lambda part, share: shares.append(share)  # noqa: E731
    detection = detect_parts(parts, fit, see, learn=0.25, whole=True, progress=done.append)
    (early,) = given
    assert detection.fitted_on_s == pytest.approx((log.time[0], log.time[0] + 0.25 * log.duration_s))
    assert detection.whole
    np.testing.assert_array_equal(np.concatenate([early.time, detection.log.time]), log.time)
    assert done[-1] == 1.0
    assert shares == [1.0]  # the page has all its detail for what was judged
