"""Make the table of usual changes by class of vehicle: `python benchmarks/class_table.py`.

From the healthy windows of real logs in SENSORFAULT_DATA (healthy.json says which), and from simulated drives and
flights. For each kind of test and class: floor = 1.5 times the median over logs of a log's largest change, and
ceiling = 2.5 times the largest of any log, both over ten. From fewer than five logs the largest counts as the median;
from fewer than three both are wider still. Writes src/sensorfault/relations/classes.toml.
"""

import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from sensorfault.logs import Log, LogError, read
from sensorfault.relations import axes, facts
from sensorfault.relations.grid import Grid, pieces_of
from sensorfault.relations.limits import TENTH
from sensorfault.relations.signals import signals_of
from sensorfault.relations.tests_of import judged
from sensorfault.relations.vehicle_class import class_of
from sensorfault.relations.witnesses import SLOW_FAST_S
from sensorfault.simulation.flapping_wing import fly
from sensorfault.simulation.road import drive

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "src" / "sensorfault" / "relations" / "classes.toml"
DATA = Path(os.environ.get("SENSORFAULT_DATA", ROOT.parent / "shared" / "data"))
FEW = (3.0, 2.0, 2.0, 1.5, 1.0)  # by how much a ceiling is wider that 0, 1, 2, 3, 4 or more real logs show
SEEDS = range(1000, 1006)
Windows = list[tuple[float, float]]


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
        flight = fly(500.0, seed, imu_hz=25.0).log
        yield f"simulated flight {seed}", flight, [(0.0, np.inf)]
        yield f"simulated flight {seed} at 5 Hz", thinned(flight), [(0.0, np.inf)]


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
                piece = judged(grid, vehicle in ("car", "wing"), {})
                for k, test in enumerate(piece.tests):
                    found[test.relation.name, test.kind].append(piece.moved[:, k])
    most: dict[tuple[str, float], float] = {}
    for (_, kind), parts in found.items():
        moved = np.concatenate(parts)
        if np.isfinite(moved).sum() > 10:
            most[kind] = max(most.get(kind, 0.0), float(np.nanmax(np.abs(moved - np.nanmedian(moved)))))
    return vehicle, most


def main() -> None:
    """Write the table."""
    table: dict[tuple[str, str, float], list[float]] = defaultdict(list)
    real: dict[tuple[str, str, float], list[float]] = defaultdict(list)
    for name, log, windows in healthy():
        vehicle, most = largest(log, windows)
        print(f"{name}: {vehicle}, {len(most)} kinds", file=sys.stderr)
        for (kind, window_s), value in most.items():
            if vehicle != "unknown":
                table[vehicle, kind, window_s].append(value)
                if not name.startswith("simulated"):
                    real[vehicle, kind, window_s].append(value)
    lines = ["# Scales of the tests by class of vehicle. Made by benchmarks/class_table.py; do not edit.", ""]
    for (vehicle, kind, window_s), values in sorted(table.items()):
        mine = real[vehicle, kind, window_s]
        few = FEW[min(len(mine), len(FEW) - 1)]
        mine = mine if len(mine) >= 3 else values  # simulated ones are too alike to outvote real ones
        usual = (float(np.median(mine)) if len(mine) > 4 else max(mine)) * (1.5 if len(mine) < 4 else 1.0)
        floor, ceiling = 1.5 * usual / TENTH, 2.5 * few * max(values) / TENTH
        lines += ["[[change]]", f'class = "{vehicle}"', f'kind = "{kind}"', f"window_s = {window_s:g}"]
        lines += [f"floor = {floor:.4g}", f"ceiling = {ceiling:.4g}", f"largest = {max(values):.4g}"]
        lines += [f"logs = {len(values)}", ""]
    TABLE.write_text("\n".join(lines))


if __name__ == "__main__":
    main()
