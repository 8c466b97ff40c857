from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Channel, Log, LogError, Sensor, read, write


def log_of(rows: int = 400, held_epoch: bool = True, epoch_s: float | None = 1.7e9) -> Log:
    """An IMU, a held speed whose repeats are sometimes new measurements, and a range that comes now and then."""
    random = np.random.default_rng(7)
    time = np.cumsum(random.uniform(0.015, 0.025, rows)) - 0.015
    gyro = random.normal(size=(rows, 2)) * 10.0 ** random.integers(-12, 6, (rows, 2))
    speed = np.repeat(np.round(random.normal(size=-(-rows // 5))), 5)[:rows, None]
    distance = np.where(np.arange(rows) % 7 == 0, random.uniform(1, 9, rows), np.nan)[:, None]
    value = np.concatenate([gyro, speed, distance], axis=1)
    fresh = np.isfinite(value)
    if held_epoch:
        fresh[:, 2] = np.arange(rows) % 5 == 0
    else:
        fresh[1:, 2] = speed[1:, 0] != speed[:-1, 0]
    return Log(
        time,
        value,
        fresh,
        (
            Channel("x", "gyro", "deg/s"),
            Channel("y", "gyro", "rad/s", watch=False),
            Channel("speed", "gnss", "km/h"),
            Channel("range", "uwb", "mm", watch=False),
        ),
        (Sensor("gyro", 0.02), Sensor("gnss", 0.1, held=True), Sensor("uwb", 0.14)),
        name="käse & co",
        epoch_s=epoch_s,
    )


def same(one: Log, other: Log) -> None:
    np.testing.assert_allclose(other.time, one.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.value, one.value, rtol=1e-12, atol=0)
    np.testing.assert_array_equal(other.fresh, one.fresh)
    assert other.channels == one.channels
    assert other.sensors == one.sensors
    assert other.name == one.name
    assert other.epoch_s == one.epoch_s


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize("held_epoch", [True, False])
@pytest.mark.parametrize("epoch_s", [None, 1.7e9])
def test_what_is_written_reads_back_the_same(
    tmp_path: Path, suffix: str, held_epoch: bool, epoch_s: float | None
) -> None:
    log = log_of(held_epoch=held_epoch, epoch_s=epoch_s)
    vehicle = write(log, tmp_path / f"faulty.{suffix}")
    assert vehicle == tmp_path / "faulty.vehicle.toml"
    same(log, read(tmp_path / f"faulty.{suffix}"))
    same(log, read(tmp_path))


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_piece_of_a_log_keeps_its_times(tmp_path: Path, suffix: str) -> None:
    piece = log_of().between(2.01, 6.0)
    assert piece.time[0] > 2
    write(piece, tmp_path / f"piece.{suffix}")
    same(piece, read(tmp_path / f"piece.{suffix}"))


def test_any_fresh_marks_survive(tmp_path: Path) -> None:
    log = log_of()
    random = np.random.default_rng(8)
    for _ in range(5):
        fresh = (random.random(log.fresh.shape) < 0.5) & np.isfinite(log.value)
        torn = Log(log.time, log.value, fresh, log.channels, log.sensors, name="torn")
        write(torn, tmp_path / "torn.csv")
        same(torn, read(tmp_path / "torn.csv"))


def test_a_sensor_that_is_silent_throughout_survives(tmp_path: Path) -> None:
    log = log_of()
    value, fresh = log.value.copy(), log.fresh.copy()
    value[:, 2], fresh[:, 2] = np.nan, False
    silent = Log(log.time, value, fresh, log.channels, log.sensors)
    write(silent, tmp_path / "silent.csv")
    same(silent, read(tmp_path / "silent.csv"))


def test_nothing_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "log.csv"
    write(log_of(), path)
    before = path.read_bytes()

    def full(*_: object, **__: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(LogError, match="cannot be written"):
        write(log_of(rows=50), path)
    assert path.read_bytes() == before
    assert sorted(file.name for file in tmp_path.iterdir()) == ["log.csv", "log.vehicle.toml"]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("log.xlsx", "written as .csv or .parquet"),
        ("no/such/log.csv", r"no/such/log.csv: cannot be written \(No such file or directory\); check the folder"),
    ],
)
def test_where_a_log_cannot_go(tmp_path: Path, name: str, sentence: str) -> None:
    with pytest.raises(LogError, match=sentence):
        write(log_of(), tmp_path / name)
    assert list(tmp_path.iterdir()) == []
