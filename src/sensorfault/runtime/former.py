"""Former names of parts and methods in older model files and commands -> the names of today."""

PARTS = {
    "Of": "SelectResidual",
    "Late": "OneSided",
    "Freed": "BaardaW",
    "AveragedFreed": "AveragedBaardaW",
    "Standing": "StuckPosition",
}
METHODS = {
    "train": "satellite-bank",
    "rail": "satellite-bank",
    "car": "car-composite",
    "drone": "drone-composite",
}
