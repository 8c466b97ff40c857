"""Make the table of usual changes by class of vehicle: `python benchmarks/class_table.py`.

From the healthy windows of real logs in SENSORFAULT_DATA (healthy.json says which), and from simulated drives and
flights. For each kind of test and class: floor = 1.5 times the median over logs of a log's largest change, and
ceiling = 2.5 times the largest of any log, both over ten. From fewer than five logs, or where none is real, the largest
counts as the median; from fewer than three both are wider still. Writes src/sensorfault/relations/classes.toml. With
`--leave-out` it writes nothing: each real log is judged by the table of all others, and its events are printed.
"""

import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sensorfault.logs import Channel, Log, LogError, Sensor, read
from sensorfault.relations import axes, facts, limits
from sensorfault.relations.grid import Grid, pieces_of
from sensorfault.relations.judge import GO_WHERE_THEY_POINT
from sensorfault.relations.limits import CLASSES
from sensorfault.relations.signals import signals_of
from sensorfault.relations.tests_of import judged
from sensorfault.relations.vehicle_class import class_of
from sensorfault.relations.witnesses import SLOW_FAST_S
from sensorfault.runtime.compared import compare
from sensorfault.simulation.flapping_wing import fly
from sensorfault.simulation.road import drive
from sensorfault.simulation.train import ride

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "src" / "sensorfault" / "relations" / "classes.toml"
DATA = Path(os.environ.get("SENSORFAULT_DATA", ROOT.parent / "shared" / "data"))
FEW = (3.0, 2.0, 2.0, 1.5, 1.0)  # by how much a ceiling is wider that 0, 1, 2, 3, 4 or more real logs show
TENTH = 10.0  # the scale of a change is a tenth of it
SEEDS = range(1000, 1006)
Windows = list[tuple[float, float]]
EXPECTED = {  # true findings in the healthy windows (healthy.json)
    ("00000164_00000001-60FE3F04.MF4", "accelerometer"),
    ("00000165_00000002-60FEB8E3.MF4", "accelerometer"),
}


@dataclass(frozen=True)
class Row:
    """Of one kind of test in one class: the least and the largest scale, the largest change, how many logs show it."""

    floor: float
    ceiling: float
    largest: float
    logs: int


@dataclass(frozen=True)
class Shown:
    """What a healthy log shows: the largest change of each kind of test."""

    name: str
    log: Log
    windows: Windows
    vehicle: str
    most: dict[tuple[str, float], float]

    @property
    def real(self) -> bool:
        """Whether it was recorded in a vehicle."""
        return not self.name.startswith("simulated")


def healthy() -> Iterator[tuple[str, Log, Windows]]:
    """Name, log and healthy windows of each real log that can be read, and of the simulated ones."""
    for entry in json.loads((DATA / "healthy.json").read_text())["logs"]:
        place, windows = DATA / entry["log"], entry["windows"]
        known = isinstance(windows, list)
        for path in [place] if known or place.is_file() else sorted(p for p in place.iterdir() if p.suffix != ".dbc"):
            if not known and "failure" in path.name:
                continue
            try:
                log = read(path)
            except LogError as error:
                print(f"left out: {error}", file=sys.stderr)
                continue
            yield path.name, log, [tuple(w) for w in windows] if known else [(0.0, np.inf)]
    for seed in SEEDS:
        yield f"simulated drive {seed}", drive(400.0, seed).log, [(0.0, np.inf)]
        yield f"simulated ride {seed}", ridden(seed), [(0.0, np.inf)]
        flight = fly(500.0, seed, imu_hz=25.0).log
        yield f"simulated flight {seed}", flight, [(0.0, np.inf)]
        yield f"simulated flight {seed} at 5 Hz", thinned(flight), [(0.0, np.inf)]


def ridden(seed: int) -> Log:
    """A train ride, with the speed by its wheels, which lose .3 % and some cm/s, at each tick."""
    made = ride(400.0, seed, imu_hz=10)
    rng = np.random.default_rng(seed)
    speed = np.linalg.norm(made.velocity, axis=1) * (1 + rng.normal(0, 0.003)) + rng.normal(0, 0.03, len(made.log))
    log = made.log
    return replace(
        log,
        value=np.column_stack([log.value, np.maximum(speed, 0.0)]),
        fresh=np.column_stack([log.fresh, np.ones(len(log), bool)]),
        channels=(*log.channels, Channel("speed", "wheel", "m/s")),
        sensors=(*log.sensors, Sensor("wheel", 10.0)),
    )


def thinned(log: Log, every: int = 5) -> Log:
    """Every fifth row, as telemetry has it."""
    return replace(log, time=log.time[::every], value=log.value[::every], fresh=np.isfinite(log.value[::every]))


def largest(log: Log, windows: Windows) -> tuple[str, dict[tuple[str, float], float]]:
    """The class of a log, and the largest change of each kind of test."""
    signals, mountings = axes.mounted(signals_of(log))
    vehicle = class_of(signals)
    unknown = {role + n for n, m in mountings.items() if m.turn is None for role in axes.INERTIAL}
    unknown |= {"gyro" + n for n, m in mountings.items() if not m.yaw}
    known = {
        "forward": float(all(m.forward for m in mountings.values())),
        "mounted": float(not any(m.why for m in mountings.values())),
    }
    if vehicle != "copter":
        known["acceleration.period"] = SLOW_FAST_S
    found: dict[tuple[str, float], list[np.ndarray]] = defaultdict(list)
    for first, last in windows:
        used = {k: c for k, s in signals.items() if k not in unknown and len((c := s.cut(first, last)).time) > 4}
        for start, end in pieces_of(used):
            if end - start >= 8:
                inside = {k: c for k, s in used.items() if len((c := s.cut(start, end)).time) >= 4}
                grid = Grid(inside, start, end, dict(known))
                grid.facts.update(facts.learned(grid))
                piece = judged(grid, vehicle in GO_WHERE_THEY_POINT, {})
                for k, test in enumerate(piece.tests):
                    found[test.relation.name, test.kind].append(piece.moved[:, k])
    most: dict[tuple[str, float], float] = {}
    for (_, kind), parts in found.items():
        moved = np.concatenate(parts)
        if np.isfinite(moved).sum() > 10:
            most[kind] = max(most.get(kind, 0.0), float(np.nanmax(np.abs(moved - np.nanmedian(moved)))))
    return vehicle, most


def rows_of(shown: list[Shown]) -> dict[str, dict[tuple[str, float], Row]]:
    """The table by class and kind of test, from what the logs show."""
    by_kind: dict[tuple[str, tuple[str, float]], list[Shown]] = defaultdict(list)
    for one in shown:
        for kind in one.most:
            by_kind[one.vehicle, kind].append(one)
    table: dict[str, dict[tuple[str, float], Row]] = {name: {} for name in CLASSES}
    for (vehicle, kind), logs in sorted(by_kind.items()):
        values, real = [one.most[kind] for one in logs], [one.most[kind] for one in logs if one.real]
        few = FEW[min(len(real), len(FEW) - 1)]
        mine = real if len(real) >= 3 else values  # simulated ones are too alike to outvote real ones
        usual = (float(np.median(mine)) if real and len(mine) > 4 else max(mine)) * (1.5 if len(mine) < 4 else 1.0)
        floor, ceiling = 1.5 * usual / TENTH, 2.5 * few * max(values) / TENTH
        table[vehicle][kind] = Row(floor, ceiling, max(values), len(values))
    return table


def written(table: dict[str, dict[tuple[str, float], Row]]) -> str:
    """The table as TOML."""
    lines = ["# Scales of the tests by class of vehicle. Made by benchmarks/class_table.py; do not edit.", ""]
    for vehicle, rows in sorted(table.items()):
        for (kind, window_s), row in sorted(rows.items()):
            lines += ["[[change]]", f'class = "{vehicle}"', f'kind = "{kind}"', f"window_s = {window_s:g}"]
            lines += [f"floor = {row.floor:.4g}", f"ceiling = {row.ceiling:.4g}", f"largest = {row.largest:.4g}"]
            lines += [f"logs = {row.logs}", ""]
    return "\n".join(lines)


def left_out(shown: list[Shown]) -> None:
    """Judge each real log by a table of all others, and print the events in its healthy windows."""
    real = [one for one in shown if one.real]
    loud = 0
    for one in real:
        others = rows_of([other for other in shown if other is not one])
        limits.table = lambda others=others: others  # type: ignore[assignment]
        found = [
            event
            for event in compare(one.log).events
            if any(start <= event.start_s <= end for start, end in one.windows)
            and (one.name, event.sensor) not in EXPECTED
        ]
        loud += bool(found)
        print(f"{one.name} ({one.vehicle}): {len(found) or 'no'} events")
        for event in found:
            who = event.sensor or " or ".join(event.candidates)
            size = f"{event.peak_score:.3g} of {event.limit:.3g}"
            print(f"    {event.start_s:.1f} s {who} {event.kind}, {event.found_by}: {size}")
    print(f"real: events in {loud} of {len(real)} healthy logs, each judged without its own figures")


def main() -> None:
    """Write the table, or judge each log by the others (`--leave-out`)."""
    shown = []
    for name, log, windows in healthy():
        vehicle, most = largest(log, windows)
        print(f"{name}: {vehicle}, {len(most)} kinds", file=sys.stderr)
        if vehicle != "unknown":
            shown.append(Shown(name, log, windows, vehicle, most))
    if "--leave-out" in sys.argv:
        left_out(shown)
    else:
        TABLE.write_text(written(rows_of(shown)))


if __name__ == "__main__":
    main()
