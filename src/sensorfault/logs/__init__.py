"""Logs: files of a drive -> one table on one clock."""

from sensorfault.logs.guess import guess
from sensorfault.logs.read import read
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile, write_vehicle_toml

__all__ = ["Channel", "Log", "LogError", "Sensor", "VehicleFile", "guess", "read", "write_vehicle_toml"]
