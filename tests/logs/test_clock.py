from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sensorfault.logs import Log, LogError, VehicleFile, guess, read
from sensorfault.logs.clock import _longest_rise

VEHICLE = '[file.log]\ntime = "t"\nunit = "{unit}"\n[sensor.s.channel]\na = {{ column = "a" }}\n'


def log_of(folder: Path, times: list[object], unit: str = "s") -> Log:
    path = folder / "log.csv"
    path.write_text("t,a\n" + "".join(f"{time},{k}\n" for k, time in enumerate(times)))
    return read(path, VehicleFile.parse(VEHICLE.format(unit=unit)))


@settings(max_examples=200, deadline=None)
@given(st.lists(st.integers(0, 6), min_size=1, max_size=7))
def test_the_kept_rows_are_the_most_that_rise(times: list[int]) -> None:
    kept = _longest_rise(np.array(times, float))
    assert all(times[i] < times[j] for i, j in pairwise(kept))
    best = max(
        len(rows)
        for size in range(1, len(times) + 1)
        for rows in combinations(range(len(times)), size)
        if all(times[i] < times[j] for i, j in pairwise(rows))
    )
    assert len(kept) == best


@pytest.mark.parametrize(("wild", "lost"), [(99.0, 1), (-50.0, 1), (9.9, 1)])
def test_one_wild_time_costs_one_row(tmp_path: Path, wild: float, lost: int) -> None:
    times = [k / 10 for k in range(100)]
    times[40] = wild
    log = log_of(tmp_path, times)
    assert len(log) == 100 - lost
    assert 40.0 not in log.value[:, 0]
    assert len([note for note in log.notes if "goes back" in note]) == 1


def test_repeated_and_late_rows_are_left_out_and_counted(tmp_path: Path) -> None:
    times = [k / 10 for k in range(100)]
    times[20] = times[19]
    times[60], times[61] = times[61], times[60]
    log = log_of(tmp_path, times)
    assert len(log) == 98
    assert (np.diff(log.time) > 0).all()
    (note,) = (note for note in log.notes if "time 't'" in note)
    assert "goes back once" in note
    assert "stands still once" in note
    assert "line 22" in note
    assert "2 rows left out" in note


def test_a_recorder_that_restarts_keeps_the_longer_part(tmp_path: Path) -> None:
    log = log_of(tmp_path, [*range(10), *range(100)])
    np.testing.assert_array_equal(log.value[:, 0], np.arange(10, 110))


def test_hopeless_time_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"out of order; sort the file by time"):
        log_of(tmp_path, list(range(100, 0, -1)))


def test_gaps_are_counted_and_left(tmp_path: Path) -> None:
    times = np.arange(200) * 0.02
    times[50:] += 0.05
    times[120:] += 1.0
    log = log_of(tmp_path, times.tolist())
    (note,) = (note for note in log.notes if "gap" in note)
    assert "2 gaps" in note
    assert "1.02 s at 2.430 s" in note
    np.testing.assert_allclose(log.time, times, atol=1e-12)


def test_jitter_is_said_and_a_steady_clock_is_silent(tmp_path: Path) -> None:
    steady = np.arange(300) * 0.02
    assert log_of(tmp_path, steady.tolist()).notes == ()
    shaken = steady + np.random.default_rng(0).uniform(-0.007, 0.007, 300)
    assert any("jitters" in note for note in log_of(tmp_path, shaken.tolist()).notes)


def test_rows_without_a_time_are_left_out(tmp_path: Path) -> None:
    times: list[object] = list(range(50))
    times[7] = ""
    times[9] = "inf"
    log = log_of(tmp_path, times)
    assert len(log) == 48
    assert any("2 rows without a time, first line 9" in note for note in log.notes)


@pytest.mark.parametrize(("unit", "scale"), [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_units_of_time(tmp_path: Path, unit: str, scale: float) -> None:
    log = log_of(tmp_path, [round(k * 0.25 * scale) if unit != "s" else k * 0.25 for k in range(8)], unit)
    np.testing.assert_allclose(log.time, np.arange(8) * 0.25, atol=1e-12)
    assert log.epoch_s is None


@pytest.mark.parametrize("zone", ["", "Z", "+00:00"])
@pytest.mark.parametrize("between", ["T", " "])
def test_dates_and_times(tmp_path: Path, zone: str, between: str) -> None:
    stamps: list[object] = [f"2026-11-23{between}12:00:{k / 4:06.3f}{zone}" for k in range(8)]
    log = log_of(tmp_path, stamps, "iso8601")
    np.testing.assert_allclose(log.time, np.arange(8) * 0.25, atol=1e-9)
    assert log.epoch_s == 1795435200.0


def test_a_date_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"line 3, column 't' holds 'noon'"):
        log_of(tmp_path, ["2026-11-23T12:00:00", "noon", "2026-11-23T12:00:01"], "iso8601")


@pytest.mark.parametrize(("unit", "zero"), [("filetime", 11_644_473_600), ("ticks", 62_135_596_800)])
def test_ticks_of_100_ns_are_known_by_their_size(tmp_path: Path, unit: str, zero: int) -> None:
    times = [(1_714_557_600 + zero) * 10_000_000 + 1_000_000 * k for k in range(50)]
    path = tmp_path / "log.csv"
    path.write_text("time,ax\n" + "".join(f"{time},{k % 7}.5\n" for k, time in enumerate(times)))
    known = guess(path)
    assert known.files[0].unit == unit
    assert VehicleFile.parse(known.to_toml()).files[0].unit == unit
    log = read(path)
    np.testing.assert_allclose(log.time, np.arange(50) / 10, atol=1e-9)
    assert log.epoch_s == 1_714_557_600.0
