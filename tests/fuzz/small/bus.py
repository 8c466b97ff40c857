"""MDF, and recordings of a CAN bus."""

from logs import written_bus

SMALL = {
    "MDF": lambda folder: written_bus.mdf(folder / "drive.mf4"),
    "CAN recording": lambda folder: written_bus.blf(folder / "drive.blf"),
    "CAN recording, as text": lambda folder: written_bus.asc(folder / "drive.asc"),
    "candump": lambda folder: written_bus.candump(folder / "drive.log"),
}
