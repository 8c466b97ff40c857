"""Whether two descriptions of columns agree."""

from typing import NamedTuple

from sensorfault.logs.phrase import with_unit
from sensorfault.logs.vehicle import VehicleFile


class _Meaning(NamedTuple):
    """What a description says of one column."""

    path: str
    unit: str
    held: bool
    missing: float | None

    def spoken(self, other: "_Meaning") -> str:
        """`gyro.x [rad/s]`, with what else differs from the other."""
        rest = " held" if self.held and not other.held else " new in each row" if other.held and not self.held else ""
        rest += f" missing = {self.missing:g}" if self.missing is not None and self.missing != other.missing else ""
        return f"{with_unit(self.path, self.unit)}{rest}"

    def agrees(self, other: "_Meaning") -> bool:
        missing = None in (self.missing, other.missing) or self.missing == other.missing
        return self[:3] == other[:3] and missing


def conflict(one: VehicleFile, other: VehicleFile) -> str:
    """The first column that the two describe in different ways, in one clause; empty if they agree.

    A column that only one of them describes is no conflict.
    """
    meanings, others = _meanings(one), _meanings(other)
    for column, here in meanings.items():
        there = others.get(column)
        if there is not None and not here.agrees(there):
            return (
                f"by {one.where} the column '{column[1]}' is {here.spoken(there)}, by {other.where} it is "
                f"{there.spoken(here)}"
            )
    clocks, other_clocks = _clocks(one), _clocks(other)
    for column, unit in clocks.items():
        if other_clocks.get(column, unit) != unit:
            return (
                f"by {one.where} the time column '{column[1]}' is in {unit}, by {other.where} in {other_clocks[column]}"
            )
    return ""


_Column = tuple[str, str]  # its table, or its file where a log has several; its name


def _tables(vehicle: VehicleFile) -> dict[str, str]:
    several = len({file.path for file in vehicle.files}) > 1
    return {file.name: file.table or (file.path or "" if several else "") for file in vehicle.files}


def _meanings(vehicle: VehicleFile) -> dict[_Column, _Meaning]:
    tables = _tables(vehicle)
    return {
        (tables[sensor.file], channel.column): _Meaning(
            f"{sensor.name}.{channel.name}", channel.unit, sensor.held, channel.missing
        )
        for sensor in vehicle.sensors
        for channel in sensor.channels
    }


def _clocks(vehicle: VehicleFile) -> dict[_Column, str]:
    tables = _tables(vehicle)
    return {(tables[file.name], file.time): file.unit for file in vehicle.files if file.time is not None}
