"""What a model knows of the columns of its logs: units, names, sensors. It is kept in the model's summary, as TOML."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from sensorfault.logs.agreement import conflict
from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.table import Log, LogError, Sensor
from sensorfault.logs.units import to_si
from sensorfault.logs.vehicle import VehicleFile

KEY, GUESSED = "description", "description_guessed"


def described(log: Log) -> dict[str, Any]:
    """For the summary of a model that is fitted on this log: what its columns were read as."""
    if log.description is None:
        return {}
    text = replace(log.description, epoch_s=None, zero_s=None, notes=()).to_toml()
    return {KEY: text, GUESSED: log.description.guessed}


def known(summary: Mapping[str, Any], inputs: Sequence[str] | None, sensors: Sequence[Sensor]) -> VehicleFile | None:
    """The description in a model's summary, with the columns that the model needs; None if there is none.

    `inputs`: the channels that it needs, None for all. A sensor's period is the one that the model knows, so that a
    sensor may be silent for a whole log.

    Raises:
        LogError: it cannot be read.
    """
    text = summary.get(KEY)
    if not isinstance(text, str):
        return None
    whole = replace(VehicleFile.parse(text, "the model"), guessed=bool(summary.get(GUESSED)))
    period = {sensor.name: sensor.period_s for sensor in sensors if np.isfinite(sensor.period_s)}
    needed = (_needed(sensor, inputs, period.get(sensor.name)) for sensor in whole.sensors)
    used = tuple(sensor for sensor in needed if sensor.channels)
    files = {sensor.file for sensor in used}
    return replace(whole, sensors=used, files=tuple(file for file in whole.files if file.name in files))


def check(log: Log, description: VehicleFile | None) -> None:
    """Whether a log was read as the model knows its columns.

    Raises:
        LogError: a column was read as something else.
    """
    if description is None or log.description is None:
        return
    if clash := conflict(log.description, description):
        raise LogError(f"{log.name}: {clash}; read it with model=model.description, or correct one of them.")


def _needed(sensor: SensorEntry, inputs: Sequence[str] | None, period_s: float | None) -> SensorEntry:
    """The sensor with the channels that are inputs; with all, where a change of any shows a new measurement."""
    if inputs is None:
        return replace(sensor, period_s=sensor.period_s or period_s)
    mine = tuple(channel for channel in sensor.channels if f"{sensor.name}.{channel.name}" in inputs)
    together = sensor.held and sensor.epoch is None and mine
    channels = sensor.channels if together else mine
    return replace(sensor, channels=channels, period_s=sensor.period_s or period_s)


def sample(description: VehicleFile | None, inputs: Sequence[str], row: Mapping[str, float]) -> Float[np.ndarray, " C"]:
    """One row of a log's columns, in the log's units -> the values of a live sample, in SI; NaN where there is none.

    Raises:
        LogError: the model does not know the columns, or none of them is in the row.
    """
    if description is None:
        raise LogError("this model does not know the columns of its log; fit it again, on a log that was read.")
    entries = {f"{sensor.name}.{c.name}": c for sensor in description.sensors for c in sensor.channels}
    if not any(entry.column in row for entry in entries.values()):
        listed = ", ".join(entry.column for entry in entries.values())
        raise LogError(f"none of the columns {', '.join(map(str, row))} is one that the model knows; give {listed}.")
    return np.array([_si(entries.get(path), row) for path in inputs])


def _si(entry: ChannelEntry | None, row: Mapping[str, float]) -> float:
    number = float(row.get(entry.column, np.nan)) if entry is not None else np.nan
    if entry is None or number == entry.missing:
        return np.nan
    return float(to_si(np.array([number]), entry.unit)[0])
