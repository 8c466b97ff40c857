"""What the names in older model files and commands are called now."""

PARTS = {
    "Of": "SelectResidual",
    "Late": "OneSided",
    "Freed": "BaardaW",
    "AveragedFreed": "AveragedBaardaW",
    "Standing": "StuckPosition",
}
METHODS = {"train": "rail"}
