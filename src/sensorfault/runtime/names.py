"""The methods that users choose among by name: the default for a class of vehicles, and two for single channels.

All others are behind `sensorfault methods --all`.
"""

from sensorfault.relations.events import METHOD

VEHICLES = {  # of the default method: name -> what it is
    METHOD: "the default: each sensor against what the others say, and levels that must hold; the class is guessed",
    "car": "the same for a car, or another vehicle that goes where it points",
    "drone": "the same for a copter or an aircraft with wings",
    "underwater": "the same for a vehicle under water",
    "rail": "the same for a train",
}
CHANNELS = {  # name -> recipe, what it is
    "imu": ("relative-conditioning", "an inertial unit alone: each channel by what it has just been"),
    "arm": ("online-network", "the joints of an arm: each by what a network expects of it"),
}


def is_default(method: str | None) -> bool:
    """Whether a name is one of the default method; None is it."""
    return method is None or method in VEHICLES


def vehicle_of(method: str | None) -> str:
    """The class of vehicles that a name of the default method says; empty if it leaves it to a guess."""
    return "" if method in (None, METHOD) else str(method)


def recipe_of(method: str) -> str:
    """The recipe that a name stands for; any other name stands for itself."""
    return CHANNELS[method][0] if method in CHANNELS else method
