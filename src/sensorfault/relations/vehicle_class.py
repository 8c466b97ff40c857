"""What kind of vehicle a log is of, judged by the sensors it has and how it moves."""

import numpy as np

from sensorfault.relations.signals import SATELLITES, Signal

FAST_M_S = 9.0  # a wing does not hover: half of its flight is faster
CLIMBS_M_S = 1.5  # what flies climbs or sinks faster than this for a twentieth of the time
CLIMB_S = 5.0
FLYING = ("copter", "wing")


def class_named(name: str, signals: dict[str, Signal]) -> str:
    """The class that a user names; "drone" is one of two, and an empty name any: then the signals show which."""
    if name not in ("", "drone"):
        return name
    guess = class_of(signals)
    return guess if not name or guess in FLYING else "copter"


def class_of(signals: dict[str, Signal]) -> str:
    """One of "copter", "wing", "car", "rail", "underwater", or "unknown".

    On the ground with raw satellites for a receiver, as trains have them, it is "rail": places that no receiver
    smoothed need wider limits.
    """
    if any(signal.sensor == SATELLITES for signal in signals.values()):
        return "rail"
    if "depth" in signals or "dvl" in signals:
        return "underwater"
    if "wheel" in signals or "steering" in signals:
        return "car"
    if "airspeed" in signals:
        return "wing"
    speed = next((signals[k].value for k in ("gnss.velocity", "gnss.speed") if k in signals), None)
    height = signals.get("barometer") or signals.get("gnss.height")
    if "barometer" in signals or "magnetometer" in signals or (height is not None and _climb(height) > CLIMBS_M_S):
        if "attitude" not in signals:
            return "unknown"
        fast = speed is not None and float(np.median(np.linalg.norm(speed, axis=1))) > FAST_M_S
        return "wing" if fast else "copter"
    return "car" if speed is not None else "unknown"


def _climb(height: Signal) -> float:
    """How fast the vehicle climbs or sinks in a twentieth of the time [m/s]."""
    h, time = height.value[:, 0], height.time
    later = np.interp(time + CLIMB_S, time, h)
    inside = time + CLIMB_S <= time[-1]
    return float(np.quantile(np.abs(later - h)[inside], 0.95)) / CLIMB_S if inside.sum() > 20 else 0.0
