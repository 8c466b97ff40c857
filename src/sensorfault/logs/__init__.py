"""Logs: the files of a drive -> one table on one clock, and back."""

from sensorfault.logs.guess import guess
from sensorfault.logs.read import read
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.logs.write import write

__all__ = ["Channel", "Log", "LogError", "Sensor", "VehicleFile", "guess", "read", "write"]
