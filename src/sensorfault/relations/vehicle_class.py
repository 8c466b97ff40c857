"""What kind of vehicle a log is of, judged by the sensors it has and how it moves."""

import numpy as np

from sensorfault.relations.signals import Signal

FAST_M_S = 9.0  # a wing does not hover: half of its flight is faster
HIGH_M = 8.0


def class_of(signals: dict[str, Signal]) -> str:
    """One of "copter", "wing", "car", "underwater", or "unknown"."""
    if "depth" in signals or "dvl" in signals:
        return "underwater"
    if "wheel" in signals or "steering" in signals:
        return "car"
    speed = next((signals[k].value for k in ("gnss.velocity", "gnss.speed") if k in signals), None)
    v = np.linalg.norm(speed, axis=1) if speed is not None else np.zeros(1)
    height = signals.get("barometer") or signals.get("gnss.height")
    rise = float(np.ptp(np.quantile(height.value[:, 0], (0.05, 0.95)))) if height is not None else 0.0
    if "airspeed" in signals or (np.median(v) > FAST_M_S and rise > HIGH_M and "attitude" in signals):
        return "wing"
    if "attitude" in signals and ("barometer" in signals or "magnetometer" in signals or rise > 2.0):
        return "copter"
    return "car" if speed is not None and rise < 200 and "attitude" not in signals else "unknown"
