"""A detection as tables, in Polars and in pandas."""

import sys
from dataclasses import replace

import numpy as np
import polars as pl
import pytest

import fitted
from sensorfault.core.verdicts import VERDICTS
from sensorfault.logs.table import LogError
from sensorfault.runtime.runners import Stepper


def test_events_are_rows_with_the_fields_of_an_event() -> None:
    found = fitted.found()
    table = found.events_table()
    assert table.rows(named=True) == [{**event.as_dict(), "candidates": None} for event in found.events]
    assert table["end_s"].null_count() == 1
    assert replace(found, events=()).events_table().columns == table.columns


def test_verdicts_are_ordered_words() -> None:
    found = fitted.found()
    table = found.verdicts_table()
    assert table.columns == ["time_s", "sample", "motion", "gyro", "accelerometer", "gnss"]
    np.testing.assert_array_equal(table["time_s"], found.log.time)
    assert table["gyro"].to_list() == [VERDICTS[code] for code in found.sensor[:, 0]]
    assert set(table["gyro"]) == {"ok", "unknown", "fault"}
    np.testing.assert_array_equal(table["sample"] > "unknown", found.sample == 2)
    wide = found.verdicts_table(channels=True)
    assert wide.columns[6:] == [channel.path for channel in found.log.channels]
    assert wide["gnss.north"].to_list() == [VERDICTS[code] for code in found.channel[:, 7]]


def test_scores_stand_beside_their_limits() -> None:
    found = fitted.found()
    table = found.scores_table()
    assert table.width == 1 + 2 * len(found.traces)
    assert table.columns[:5] == ["time_s", "norm", "norm, limit", "repeats of gyro.x", "repeats of gyro.x, limit"]
    trace = found.traces[0]
    np.testing.assert_array_equal(table["norm"].to_numpy(), trace.score)
    holed = replace(trace, score=np.where(np.arange(len(trace.score)) % 5 == 0, np.nan, trace.score))
    norm = replace(found, traces=(holed,)).scores_table()["norm"]
    assert norm.null_count() == len(norm) / 5
    assert not norm.is_nan().any()
    twice = replace(found, traces=(trace, trace)).scores_table()
    assert twice.columns == ["time_s", "norm", "norm, limit", "norm (2)", "norm, limit (2)"]


def test_residuals_are_those_of_the_live_steps() -> None:
    found, model = fitted.found(), fitted.model()
    table = found.residuals_table()
    assert table.columns == ["time_s", *(channel.path for channel in found.log.channels)]
    step, log = Stepper(model.monitor), found.log
    for i in range(300):
        now = step.push(log.time[i], log.value[i], log.fresh[i])
        expected = np.where(now.valid, now.residual, np.nan)
        row = [np.nan if cell is None else cell for cell in table.row(i)[1:]]
        np.testing.assert_allclose(row, expected, rtol=1e-9)
    assert table["gnss.east"].null_count() == len(table)  # slower than the clock: not judged
    assert 0 < table["gyro.x"].null_count() < len(table) / 4


def test_a_detection_without_residuals_says_so() -> None:
    with pytest.raises(LogError, match=r"rig 0: this detection keeps no residuals; run sf\.detect"):
        replace(fitted.found(), residual=None).residuals_table()


def test_pandas_has_the_same_cells() -> None:
    pd = pytest.importorskip("pandas")
    found = fitted.found()
    for name in ("events_table", "verdicts_table", "scores_table", "residuals_table"):
        ours, theirs = getattr(found, name)(), getattr(found, name)(pandas=True)
        assert isinstance(ours, pl.DataFrame)
        assert isinstance(theirs, pd.DataFrame)
        assert list(theirs.columns) == ours.columns
        for column in ours.columns:
            cells = [None if pd.isna(cell) else cell for cell in theirs[column]]
            assert cells == ours[column].to_list(), column
    verdict = found.verdicts_table(pandas=True)["gyro"]
    assert (verdict > "unknown").sum() == (found.sensor[:, 0] == 2).sum()


def test_without_pandas_one_sentence_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pandas is not installed; run `pip install pandas`, or leave out pandas="):
        fitted.found().events_table(pandas=True)
