"""Write a log so that it reads back the same: a table, and beside it the vehicle file that describes it."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool

from sensorfault.core.expect import LOG, expect, expect_path
from sensorfault.core.extras import require
from sensorfault.core.files import appearing
from sensorfault.logs.entries import ChannelEntry, FileEntry, SensorEntry
from sensorfault.logs.held import fresh_rows
from sensorfault.logs.place import VEHICLE
from sensorfault.logs.table import Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile

if TYPE_CHECKING:
    import polars

TIME = "time_s"


def write(log: Log, path: str | Path) -> Path:
    """Write a log as CSV or Parquet, values in their channels' units, and `NAME.vehicle.toml` beside it.

    Both files appear whole or not at all. `read(path)` gives back the same log: times to 1e-9 s, values to 1e-12 of
    themselves, the same fresh marks.

    Returns:
        The path of the vehicle file.

    Raises:
        LogError: another suffix than .csv or .parquet, or the folder cannot be written to.
        MissingLibrary: polars is not installed.
        TypeError: something else than a log or a path.
    """
    expect(log, Log, "write: log", LOG)
    expect_path(path, "write: path")
    path = Path(path)
    require(f"{path}: writing it", "polars")
    frame, vehicle = as_table(log, path.name)
    writers: dict[str, Callable[[Path], object]] = {".csv": frame.write_csv, ".parquet": frame.write_parquet}
    writer = writers.get(path.suffix.lower())
    if writer is None:
        raise LogError(
            f"{path}: a log can be written as {' or '.join(writers)}, not as '{path.suffix}'; change the name."
        )
    beside = path.with_suffix(f".{VEHICLE}")
    text = vehicle.to_toml()
    _appear(path, writer)
    _appear(beside, lambda file: file.write_text(text, encoding="utf-8"))
    return beside


def as_table(log: Log, file_name: str | None = None) -> "tuple[polars.DataFrame, VehicleFile]":
    """A log's table, and the description of that table; `file_name`: what the table will be called.

    Where the fresh marks do not follow from the values, `SENSOR.epoch` columns count the measurements.
    """
    frame = log.frame()
    counts = []
    entries = []
    for sensor in log.sensors:
        columns = list(log.of(sensor.name))
        value, fresh = log.value[:, columns], log.fresh[:, columns]
        arrived: Bool[np.ndarray, " T"] = np.any(fresh, axis=1)
        sensor_epoch, channel_epoch = None, dict.fromkeys(columns, "")
        if not np.array_equal(fresh, fresh_rows(value, sensor.held, None)):
            if np.array_equal(fresh, np.isfinite(value) & arrived[:, None]):
                sensor_epoch = f"{sensor.name}.epoch"
                counts.append(_count(sensor_epoch, arrived))
            else:
                channel_epoch = {i: f"{log.channels[i].path}.epoch" for i in columns}
                counts += [_count(name, log.fresh[:, i]) for i, name in channel_epoch.items()]
        channels = tuple(
            ChannelEntry(
                log.channels[i].name,
                log.channels[i].path,
                log.channels[i].unit,
                epoch=channel_epoch[i] or None,
                watch=log.channels[i].watch,
                kind=log.channels[i].kind,
            )
            for i in columns
        )
        entries.append(_entry(sensor, channels, sensor_epoch))
    vehicle = VehicleFile(
        log.name,
        (FileEntry(path=file_name, time=TIME),),
        tuple(entries),
        epoch_s=log.epoch_s,
        zero_s=0.0,
        wheelbase_m=log.wheelbase_m,
        steering_ratio=log.steering_ratio,
    )
    return frame.with_columns(counts), vehicle


def _entry(sensor: Sensor, channels: tuple[ChannelEntry, ...], epoch: str | None) -> SensorEntry:
    period = sensor.period_s if np.isfinite(sensor.period_s) else None
    return SensorEntry(sensor.name, channels, held=sensor.held, epoch=epoch, period_s=period)


def _count(name: str, arrived: np.ndarray) -> "polars.Series":
    """How many measurements have arrived; empty before the first."""
    import polars as pl

    count = pl.Series(name, np.cumsum(arrived))
    return count.set(count == 0, None)


def _appear(path: Path, writer: Callable[[Path], object]) -> None:
    import polars as pl

    try:
        with appearing(path) as temporary:
            writer(temporary)
    except (OSError, pl.exceptions.PolarsError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LogError(f"{path}: cannot be written ({reason}); check the folder and its permissions.") from None
