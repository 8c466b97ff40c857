"""What the demo shows: a simulated log, how much of it to fit on, and the faults to inject into the rest."""

from collections.abc import Callable
from dataclasses import dataclass

from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Log


@dataclass(frozen=True)
class Scenario:
    """`make` simulates a log from a seed. Its first `learn_s` are healthy; the faults come later, `pause_s` apart."""

    words: str
    vehicle: str
    method: str
    make: Callable[[int], Log]
    learn_s: float
    pause_s: float
    faults: tuple[Fault, ...]


def _drive(seed: int) -> Log:
    from sensorfault.simulation.road import drive

    return drive(600.0, seed).log


def _flight(seed: int) -> Log:
    from sensorfault.simulation.flapping_wing import fly

    return fly(1200.0, seed, imu_hz=25.0).log


DRIVE = Scenario(
    words="drive",
    vehicle="car",
    method="relative-conditioning",
    make=_drive,
    learn_s=240.0,
    pause_s=10.0,
    faults=(
        Fault("spike", "gyro", "z", 0, 0, 20, sigmas=True),
        Fault("spike", "accelerometer", "x", 0, 0, 20, sigmas=True),
        Fault("offset", "accelerometer", "y", 0, 15, 20, sigmas=True),
        Fault("offset", "gyro", "x", 0, 15, 20, sigmas=True),
        Fault("frozen", "gyro", "y", 0, 10),
        Fault("frozen", "accelerometer", None, 0, 5),
        Fault("missing", "gyro", None, 0, 5),
        Fault("missing", "gnss", None, 0, 5),
    ),
)
FLIGHT = Scenario(
    words="flight",
    vehicle="drone",
    method="height-agreement",
    make=_flight,
    learn_s=500.0,
    pause_s=90.0,
    faults=(
        Fault("drift", "gnss", "altitude", 0, 60, 0.5),
        Fault("offset", "gnss", "altitude", 0, 20, 25),
        Fault("missing", "barometer", None, 0, 10),
    ),
)
