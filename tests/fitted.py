"""Logs and fitted models that several test files share, made once a process."""

from dataclasses import replace
from functools import cache

import numpy as np

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import Injected, inject
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection

HZ = 50
FIX_EVERY = 5
CHANNELS = (
    *(Channel(axis, "gyro", "deg/s") for axis in "xyz"),
    *(Channel(axis, "accelerometer", "m/s^2") for axis in "xyz"),
    Channel("east", "gnss", "m"),
    Channel("north", "gnss", "m"),
)
SENSORS = (Sensor("gyro", 1 / HZ), Sensor("accelerometer", 1 / HZ), Sensor("gnss", FIX_EVERY / HZ, held=True))
LEARN_S = 100.0


@cache
def rig(duration_s: float = 200.0, seed: int = 0, hz: float = HZ) -> Log:
    """A healthy test rig: six channels at 50 Hz that share three slow causes, and a held fix at 10 Hz.

    Causes and noise are bounded, so that what is not injected never leaves the range of the training.
    """
    rng = np.random.default_rng(seed)
    time = np.arange(round(duration_s * hz)) / hz
    causes = np.sin(np.outer(time, (0.9, 1.7, 2.3)) + rng.uniform(0, 6, 3))
    mixing = np.random.default_rng(7).uniform(-1, 1, (3, 6))  # of the rig, not of the drive
    scale = np.array([0.1, 0.1, 0.4, 1.0, 2.0, 0.7])
    imu = (causes @ mixing + rng.uniform(-0.1, 0.1, (len(time), 6))) * scale + np.array([0, 0, 0, 0, 0, 9.8])
    fix = np.cumsum(rng.uniform(0.5, 1.5, (len(time), 2)), axis=0)
    rows = np.arange(len(time))
    held = fix[rows - rows % FIX_EVERY]
    fresh = np.ones((len(time), 8), bool)
    fresh[:, 6:] = (rows % FIX_EVERY == 0)[:, None]
    return Log(time, np.concatenate([imu, held], axis=1), fresh, CHANNELS, SENSORS, f"rig {seed}")


@cache
def model(method: str = "elm-autoencoder") -> Model:
    return fit(rig().between(end_s=LEARN_S), method, held_out=0.0)


@cache
def unseen() -> Log:
    """The rest of the rig's log, healthy."""
    return rig().between(LEARN_S)


FAULTS = (
    Fault("spike", "gyro", "x", 105.0, 0.0, 20.0, sigmas=True),
    Fault("offset", "gyro", "z", 110.0, 5.0, 20.0, sigmas=True),
    Fault("offset", "accelerometer", None, 120.0, 3.0, 20.0, sigmas=True),
    Fault("drift", "accelerometer", "y", 128.0, 6.0, 10.0, sigmas=True),
    Fault("frozen", "gyro", "y", 140.0, 5.0),
    Fault("frozen", "accelerometer", None, 148.0, 4.0),
    Fault("noise", "accelerometer", "x", 156.0, 5.0, 20.0, sigmas=True),
    Fault("missing", "gyro", None, 165.0, 3.0),
    Fault("missing", "accelerometer", "z", 171.0, 2.0),
    Fault("scale", "accelerometer", "z", 176.0, 4.0, 5.0),
    Fault("delay", "gyro", "z", 183.0, 4.0, 1.0),
    Fault("missing", "gnss", None, 190.0, 3.0),
    Fault("offset", "gyro", "x", 197.0, 10.0, 20.0, sigmas=True),  # outlasts the log
)


@cache
def lying() -> Injected:
    """The unseen part with faults of every kind."""
    return inject(unseen(), FAULTS)


@cache
def found() -> Detection:
    return detect(model(), lying().log)


def shifted(log: Log, value: np.ndarray) -> Log:
    return replace(log, value=value, fresh=log.fresh & np.isfinite(value))
