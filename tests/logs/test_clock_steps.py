"""Clocks that jump by days are continued; what is merely late or repeated is left out and counted."""

from pathlib import Path

import numpy as np
import pytest

from logs import written_ulog
from sensorfault.logs import Log, LogError, VehicleFile, read

VEHICLE = '[file.log]\ntime = "t"\nunit = "{unit}"\n[sensor.s.channel]\na = {{ column = "a" }}\n'


def log_of(folder: Path, times: list[str], unit: str = "s") -> Log:
    path = folder / "log.csv"
    path.write_text("t,a\n" + "".join(f"{time},{k % 7}.5\n" for k, time in enumerate(times)))
    return read(path, VehicleFile.parse(VEHICLE.format(unit=unit)))


def jumps(log: Log) -> list[str]:
    return [note for note in log.notes if "jumps" in note]


@pytest.mark.parametrize(
    ("back", "said"),
    [(1024 * 604_800.0, "back by 7168 days"), (604_800.0, "back by 7 days"), (86_400.0, "back by 1 days")],
)
def test_a_clock_that_wraps_is_continued(tmp_path: Path, back: float, said: str) -> None:
    steady = 1.72e9 + np.arange(200) * 0.05
    log = log_of(tmp_path, [f"{time - (back if k >= 150 else 0):.3f}" for k, time in enumerate(steady)])
    np.testing.assert_allclose(log.time, steady - steady[0], atol=1e-5)
    (note,) = jumps(log)
    assert said in note
    assert "line 152" in note


def test_a_pause_at_the_end_of_a_week_stays(tmp_path: Path) -> None:
    steady = 604_000.0 + np.append(np.arange(100), np.arange(100) + 130.0) * 8.0
    log = log_of(tmp_path, [f"{time % 604_800:.1f}" for time in steady])
    np.testing.assert_allclose(log.time, steady - steady[0], atol=1e-6)


def test_midnight_is_no_jump_back(tmp_path: Path) -> None:
    clock = [f"{h:02d}:{m:02d}:{s:02d}" for h, m in ((23, 59), (0, 0)) for s in range(60)]
    log = log_of(tmp_path, clock, "%H:%M:%S%.f")
    np.testing.assert_allclose(log.time, np.arange(120.0), atol=1e-6)
    assert len(jumps(log)) == 1


def test_a_counter_of_32_bits_wraps(tmp_path: Path) -> None:
    micros = [(2**32 - 1_000_000 + 20_000 * k) % 2**32 for k in range(200)]
    log = log_of(tmp_path, [str(one) for one in micros], "us")
    np.testing.assert_allclose(log.time, np.arange(200) * 0.02, atol=1e-9)


def test_a_clock_set_right_after_a_while_is_continued(tmp_path: Path) -> None:
    """A receiver begins with the date of its firmware and knows better after some rows."""
    shown = [1.1e9 + k if k < 50 else 1.1e9 + 1024 * 604_800 + k for k in range(200)]
    log = log_of(tmp_path, [f"{time:.1f}" for time in shown])
    np.testing.assert_allclose(log.time, np.arange(200.0), atol=1e-5)
    assert "ahead by 7168 days" in jumps(log)[0]


def test_one_or_two_wrong_readings_are_no_jump(tmp_path: Path) -> None:
    times = [1.7e9 + k for k in range(100)]
    times[40], times[70], times[71] = 0.0, 1.0, 2.0
    log = log_of(tmp_path, [f"{time:.1f}" for time in times])
    assert len(log) == 97
    assert not jumps(log)


def test_a_recorder_that_was_off_for_days_is_no_jump(tmp_path: Path) -> None:
    times = [1.7e9 + k + (3.3 * 86_400 if k >= 50 else 0) for k in range(100)]
    assert np.diff(log_of(tmp_path, [f"{time:.1f}" for time in times]).time).max() > 3 * 86_400


def table(shown: np.ndarray) -> list[str]:
    return [f"{time:.3f}" for time in shown]


@pytest.mark.parametrize("back", [2.0, 5.0, 30.0])
def test_a_clock_set_back_by_seconds_is_continued(tmp_path: Path, back: float) -> None:
    steady = 1.72e9 + np.arange(4000) * 0.05
    log = log_of(tmp_path, table(np.where(np.arange(4000) < 3000, steady, steady - back)))
    np.testing.assert_allclose(log.time, steady - steady[0], atol=1e-5)
    (jump,) = log.jumps
    assert (jump.time_s, jump.step_s) == (pytest.approx(150.0, abs=1e-5), pytest.approx(-back, abs=1e-5))
    assert f"back by {back:g} s at line 3002" in jumps(log)[0]


def test_rows_that_come_late_are_no_clock_that_is_set(tmp_path: Path) -> None:
    late = np.r_[0:1000, 1100:1150, 1000:1100, 1150:2000]
    twice = np.r_[0:1000, 900:2000]
    for rows, kept in ((late, 1950), (twice, 2000)):
        path = tmp_path / "log.csv"
        path.write_text("t,a\n" + "".join(f"{0.05 * k:.2f},{float(np.sin(k))!r}\n" for k in rows.tolist()))
        log = read(path, VehicleFile.parse(VEHICLE.format(unit="s")))
        assert (len(log), log.jumps) == (kept, ())


def test_a_table_of_two_sensors_in_turns_is_no_clock_that_is_set(tmp_path: Path) -> None:
    turns = np.concatenate([np.tile(np.arange(20 * k, 20 * k + 20), 2) for k in range(20)]) * 0.05
    with pytest.raises(LogError, match="out of order"):
        log_of(tmp_path, table(turns))


def test_the_end_of_a_week_is_no_fault_of_the_clock(tmp_path: Path) -> None:
    steady = 604_790.0 + np.arange(400) * 0.05
    log = log_of(tmp_path, table(steady % 604_800))
    assert log.duration_s == pytest.approx(19.95)
    assert log.jumps == ()
    assert len(log_of(tmp_path, table(np.where(np.arange(400) < 200, steady, steady - 604_800) + 1.7e9)).jumps) == 1


def test_the_clock_of_all_topics_jumps_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a ULog each topic has the clock in its rows."""
    plain = written_ulog.data

    def moved(topic: str, instance: int, us: int, *values: float) -> bytes:
        return plain(topic, instance, us - (5_000_000 if us > 40_000_000 else 0), *values)

    monkeypatch.setattr(written_ulog, "data", moved)
    (tmp_path / "flight.ulg").write_bytes(written_ulog.flight(60.0))
    log = read(tmp_path / "flight.ulg")
    assert log.duration_s == pytest.approx(59.98, abs=0.05)
    (jump,) = log.jumps
    assert jump.step_s == pytest.approx(-5.0, abs=1e-6)
