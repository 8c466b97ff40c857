"""A table in memory is read as the CSV file of the same cells."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import fitted
from cli.conftest import write_csv
from sensorfault.logs import Log, LogError, VehicleFile, read
from sensorfault.logs.memory import source_of

NUMBERS = st.floats(-1e6, 1e6, allow_subnormal=False)


def same(one: Log, other: Log) -> None:
    np.testing.assert_array_equal(one.time, other.time)
    np.testing.assert_array_equal(one.value, other.value)
    np.testing.assert_array_equal(one.fresh, other.fresh)
    assert (one.channels, one.sensors, one.epoch_s) == (other.channels, other.sensors, other.epoch_s)


def attempt(table: Path | pl.DataFrame) -> tuple[Log | None, str]:
    """The log, or why there is none, without the name of what was read."""
    try:
        return read(table), ""
    except LogError as error:
        return None, str(error).split(": ", 1)[1]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Thirty seconds of the rig with holes in three sensors."""
    log = fitted.lying().log.between(164.0, 194.0)
    return write_csv(tmp_path_factory.mktemp("memory") / "drive.csv", log)


def test_a_polars_table_is_the_log_of_its_file(file: Path) -> None:
    log = read(pl.read_csv(file))
    same(log, read(file))
    assert len(log) == 1500
    assert log.name == "table"
    assert np.isnan(log.value).any()
    assert log.notes[0].startswith("No vehicle file: ")
    same(read(pl.read_csv(file, infer_schema=False)), log)  # all cells are text


def test_a_dict_of_arrays_or_lists_is_the_log_of_its_file(file: Path) -> None:
    frame = pl.read_csv(file)
    same(read({name: frame[name].to_numpy() for name in frame.columns}), read(file))
    same(read({name: frame[name].to_list() for name in frame.columns}), read(file))
    same(read({name: frame[name] for name in frame.columns}), read(file))


def test_a_pandas_table_is_the_log_of_its_file(file: Path) -> None:
    pd = pytest.importorskip("pandas")
    table, log = pd.read_csv(file), read(file)
    same(read(table), log)
    same(read(table.convert_dtypes()), log)
    same(read(table.set_index("time_s")), log)
    same(read(table.astype(object)), log)
    same(read({name: table[name] for name in table.columns}), log)


def test_a_pandas_index_is_the_time(file: Path) -> None:
    pd = pytest.importorskip("pandas")
    table, log = pd.read_csv(file), read(file)
    since = pd.to_timedelta(table.pop("time_s"), unit="s")
    by_span = read(table.set_axis(pd.TimedeltaIndex(since, name=None)))
    np.testing.assert_allclose(by_span.time, log.time, atol=1e-9)
    np.testing.assert_array_equal(by_span.value, log.value)
    dates = pd.DatetimeIndex(pd.Timestamp("2026-01-01T01:00", tz="Europe/Berlin") + since, name=None)
    by_date = read(table.set_axis(dates))
    np.testing.assert_allclose(by_date.time, log.time, atol=1e-6)
    assert by_date.epoch_s == pytest.approx(1767225600 + 164.0)
    assert by_date.channels == log.channels


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(values=arrays(float, (20, 3), elements=NUMBERS), holes=arrays(bool, (20, 3)), ints=st.booleans())
def test_any_numbers_come_out_as_from_a_file(tmp_path: Path, values: np.ndarray, holes: np.ndarray, ints: bool) -> None:
    if ints:
        values = np.round(values)
    holes[0] = False
    frame = pl.DataFrame({"t": np.arange(20) / 10} | {f"gyro_{a}": values[:, i] for i, a in enumerate("xyz")})
    frame = frame.with_columns(
        pl.when(pl.Series(~holes[:, i])).then(pl.col(f"gyro_{a}")).alias(f"gyro_{a}") for i, a in enumerate("xyz")
    )
    frame.write_csv(tmp_path / "any.csv")
    log, said = attempt(tmp_path / "any.csv")
    here, said_here = attempt(frame)
    assert said == said_here
    assert (log is None) == (here is None)
    if log is not None and here is not None:
        same(here, log)


def test_whole_numbers_that_a_float_would_round_stay_whole() -> None:
    start = 1_767_225_600_000_000_000
    time = start + np.arange(5, dtype=np.int64) * 10_000_001
    log = read({"time_ns": time, "gyro_x": [0.1, 0.3, 0.2, 0.5, 0.4]})
    np.testing.assert_allclose(log.time, np.arange(5) * 0.010000001, rtol=1e-12)
    assert log.epoch_s == pytest.approx(start / 1e9)


def test_a_vehicle_file_says_what_the_columns_are(tmp_path: Path) -> None:
    text = """
    [file.log]
    time = "millis"
    unit = "ms"
    [sensor.wheel.channel]
    speed = { column = "v", unit = "km/h", missing = -1 }
    """
    table = {"millis": [0, 20, 40], "v": [36.0, -1.0, 72.0], "other": ["a", "b", "c"]}
    (tmp_path / "vehicle.toml").write_text(text)
    for vehicle in (VehicleFile.parse(text), tmp_path / "vehicle.toml", str(tmp_path / "vehicle.toml")):
        log = read(table, vehicle)
        np.testing.assert_allclose(log.time, [0.0, 0.02, 0.04])
        np.testing.assert_allclose(log.value[:, 0], [10.0, np.nan, 20.0])
        assert [channel.path for channel in log.channels] == ["wheel.speed"]
        assert not any("guess" in note for note in log.notes)


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({}, "table: the table is empty; give one with rows."),
        ({"time": []}, "table: the table is empty; give one with rows."),
        ({"time": [0, 1, 2], "x": [1, 2]}, "table: column 'x' has 2 rows and 'time' has 3; give as many of each."),
        ({"time": [0, 1], "v": np.zeros((2, 3))}, "table: column 'v' is an array of 2 axes; give one array a column."),
        ({"a": [1, 1, 1], "b": [3, 2, 1]}, "table: there is no time column"),
        ({"time": [0, 1, 2], "v": [1.5, None, "x"]}, "table: "),
    ],
)
def test_what_is_no_log_is_one_sentence(table: dict, sentence: str) -> None:
    with pytest.raises(LogError) as refused:
        read(table)
    assert str(refused.value).startswith(sentence)
    assert "\n" not in str(refused.value)


def test_a_column_that_is_none_is_named() -> None:
    with pytest.raises(TypeError, match=r"read: column 'time' is an int \(3\); give an array or a list"):
        read({"time": 3})


def test_two_pandas_columns_of_one_name_are_refused() -> None:
    pd = pytest.importorskip("pandas")
    with pytest.raises(LogError, match="two columns are called 'v'; rename one"):
        read(pd.DataFrame([[0, 1, 2], [1, 2, 3]], columns=["time", "v", "v"]))


def test_columns_of_lists_are_left_out_and_said() -> None:
    source = source_of(pl.DataFrame({"time": [0.0, 1.0], "v": [1.0, 2.5], "points": [[1, 2], [3]]}))
    assert source.frame.columns == ["time", "v"]
    assert source.notes == ("table: 1 columns hold lists or structures and were left out.",)
