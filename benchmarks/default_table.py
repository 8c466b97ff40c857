"""How soon the default finds faults in real logs, fitted on others: `python benchmarks/default_table.py`.

Real logs (SENSORFAULT_DATA) with injected faults. Each fault begins at several times and lasts to the end; printed are
how many were found with the right device named, the median time from onset to the event, and who else was named. First
the events of the same log without a fault, judged with the same model.
"""

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sensorfault.logs import Log, read
from sensorfault.runtime.compared import Comparison, compare, comparison_of

ROOT = Path(__file__).parents[1]
DATA = Path(os.environ.get("SENSORFAULT_DATA", ROOT.parent / "shared" / "data"))
EARTH_M = 6_371_000.0
How = Callable[[np.ndarray, np.ndarray], np.ndarray]  # time since the onset [s], value -> value


@dataclass(frozen=True)
class Fault:
    """What is wrong: channels and how; `named`: who must be named."""

    what: str
    named: tuple[str, ...]
    how: dict[str, How]


def ramp(rate: float) -> How:
    return lambda t, x: x + rate * t


def off(size: float) -> How:
    return lambda t, x: x + size


def frozen(t: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.full_like(x, x[np.isfinite(x)][0])


def scaled(factor: float) -> How:
    return lambda t, x: factor * x


def lying(log: Log, fault: Fault, onset_s: float) -> Log:
    value = log.value.copy()
    rows = log.time >= onset_s
    for path, how in fault.how.items():
        column = log.index(path)
        value[rows, column] = how(log.time[rows] - onset_s, value[rows, column])
    return replace(log, value=value)


def drive(folder: str) -> tuple[Log, Log]:
    log = read(DATA / folder)
    half = log.time[0] + log.duration_s / 2
    return log.between(end_s=half), log.between(half)


def tried(name: str, log: Log, model: Comparison, faults: list[Fault], onsets: list[float]) -> None:
    clean = compare(log, model).events
    print(f"{name}: {len(clean)} events without a fault")
    for event in clean:
        print(f"    {event.start_s:.1f} s {event.sensor or ' or '.join(event.candidates)}, {event.found_by}")
    for fault in faults:
        delays, others = [], set()
        for onset in onsets:
            events = [e for e in compare(lying(log, fault, onset), model).events if e.start_s >= onset - 1]
            mine = [e for e in events if e.sensor in fault.named or (not e.sensor and "or" in fault.named)]
            others |= {e.sensor or "unknown which" for e in events if e not in mine}
            delays += [min(e.start_s for e in mine) - onset] if mine else []
        found = f"{np.median(delays):5.1f} s ({min(delays):.1f} to {max(delays):.1f})" if delays else "    -"
        print(
            f"  {fault.what:28} {len(delays)} of {len(onsets)} named, {found}" + (f"; also {others}" if others else "")
        )


def north(m: float) -> float:
    return m / EARTH_M


def main() -> None:
    jd = {n: read(DATA / "uav" / "copter_jd2014" / f"jd_{n}.bin") for n in ("200424", "204405", "211907")}
    tried(
        "jd_204405, fitted on jd_200424 and jd_211907",
        jd["204405"],
        comparison_of(jd["200424"], jd["211907"]),
        [
            *(Fault(f"height ramp {r} m/s", ("gnss",), {"gnss.altitude": ramp(r)}) for r in (0.1, 0.3, 1.0)),
            Fault("position ramp .5 m/s", ("gnss",), {"gnss.latitude": ramp(north(0.5))}),
            *(Fault(f"position jump {m} m", ("gnss",), {"gnss.latitude": off(north(m))}) for m in (5, 15)),
            Fault("barometer frozen", ("barometer",), {"barometer.altitude": frozen}),
            Fault("barometer drifts .3 m/s", ("barometer",), {"barometer.altitude": ramp(0.3)}),
            Fault("yaw gyro 2 deg/s", ("gyro",), {"gyro.z": off(np.radians(2))}),
            Fault("accelerometer z .5 m/s2", ("accelerometer",), {"accelerometer.z": off(0.5)}),
        ],
        [100.0, 150.0, 200.0],
    )
    first, second = drive("road/gnss_imu_drive0708")
    tried(
        "drive0708, second half, fitted on the first",
        second,
        comparison_of(first),
        [
            Fault("height ramp .1 m/s", ("gnss",), {"gnss.height": ramp(0.1)}),
            Fault("position ramp .5 m/s", ("gnss",), {"gnss.latitude": ramp(north(0.5))}),
            Fault("yaw gyro .5 deg/s", ("gyro",), {"gyro.z": off(np.radians(0.5))}),
        ],
        [second.time[0] + s for s in (60.0, 110.0, 160.0)],
    )
    town = read(DATA / "gnss" / "smartloc_berlin_potsdamer_platz" / "Berlin_Potsdamer_Platz_Input.txt")
    half = town.time[0] + town.duration_s / 2
    tried(
        "smartLoc, second half, fitted on the first",
        town.between(half),
        comparison_of(town.between(end_s=half)),
        [Fault("wheel 5 %", ("odometry", "or"), {"odometry.x": scaled(1.05)})],
        [half + s for s in (30.0, 50.0, 70.0)],
    )


if __name__ == "__main__":
    sys.exit(main())
