"""Experiment A4: offset and missing faults in a whole car, with one recipe and one false alarm budget.

Also spike and frozen faults of the inertial unit; frozen positions are experiment A2.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from sensorfault.evaluation.cells import Cell, tabulate
from sensorfault.evaluation.judge import Outcome, judge
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.faults.plan import plan
from sensorfault.logs import read
from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.methods.catalog import recipe
from sensorfault.numerics.geodesy import meridian_radius, transverse_radius
from sensorfault.numerics.poisson import rate_below
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection
from sensorfault.training.session import Session
from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings, Row

DRIVES = {"dresden_50hz": "road/dresden_50hz", "drive0708": "road/gnss_imu_drive0708"}
METHOD = "car-composite"
LEARN = 0.6
BIAS_S, PAUSE_S = 20.0, 8.0
SIGMAS, METRES = (1.0, 2.0, 5.0), (2.0, 5.0, 15.0)
SILENCES_S = (0.5, 1.0, 2.0, 5.0, 10.0)
JAM_S, SPIKE_SIGMAS = 5.0, 10.0
DETECTABLE = 0.9


@dataclass(frozen=True)
class _Drive:
    name: str
    model: Model
    rest: Log
    clean: Detection


def bias_miss(effort: Effort) -> Findings:
    """Recall, delay and isolation by kind, channel and size, on the last 40 % of both real drives."""
    rows: list[Row] = []
    for n, (name, folder) in enumerate(DRIVES.items()):

        def progress(share: float, name: str = name, n: int = n) -> None:
            effort.progress(f"A4 {name}", (n + share) / len(DRIVES))

        progress(0.0)
        log = read(real(folder))
        cut = float(log.time[0]) + LEARN * log.duration_s
        model = recipe(METHOD).build(log.between(end_s=cut), 0, Session())
        rest = log.between(cut)
        drive = _Drive(name, model, rest, detect(model, rest))
        rows += _clean(drive)
        cells = tabulate(_outcomes(drive, effort, progress), drive.clean)
        rows += [row for cell in cells for row in _rows(drive, cell, effort.seeds)]
    return Findings(tuple(rows), (), _remarks(rows))


def _clean(drive: _Drive) -> Iterator[Row]:
    """False alarms an hour without injected faults, with the upper 95 % bound for so short a time."""
    alarms, hours = len(drive.clean.events), drive.rest.duration_s / 3600
    for condition, value in (("per-hour", alarms / hours), ("per-hour bound95", rate_below(alarms, hours))):
        yield Row("A4", drive.name, "real", condition, METHOD, None, None, "far", value)


def _outcomes(drive: _Drive, effort: Effort, progress: Callable[[float], None]) -> list[Outcome]:
    """Inject every fault into a copy of the rest; several in one copy if they fit with pauses between them."""
    outcomes: list[Outcome] = []
    wanted = [one for _ in range(1 if effort.quick else effort.seeds) for one in _wanted(drive.rest, effort.quick)]
    batches = list(_batches(wanted, drive.rest.duration_s))
    for seed, batch in enumerate(batches):
        faults = plan(drive.rest, batch, pause_s=PAUSE_S, seed=seed)
        injected = [part for fault in faults for part in _parts(fault, drive.rest, seed)]
        found = detect(drive.model, inject(drive.rest, injected, seed).log)
        outcomes += judge(found, faults).outcomes
        progress((seed + 1) / len(batches))
    return outcomes


def _wanted(log: Log, quick: bool) -> Iterator[Fault]:
    """One fault of each kind, channel and size; four of each on the position, in random directions."""
    for channel in (c for c in log.channels if c.name in ("x", "y", "z")):
        for size in SIGMAS[-1:] if quick else SIGMAS:
            yield Fault("offset", channel.sensor, channel.name, 0.0, BIAS_S, size, sigmas=True)
        yield Fault("frozen", channel.sensor, channel.name, 0.0, JAM_S)
        yield Fault("spike", channel.sensor, channel.name, 0.0, 0.0, SPIKE_SIGMAS, sigmas=True)
    receiver = log.channels[log.index("latitude")].sensor
    for metres in METRES[-1:] if quick else METRES:
        yield from 4 * [Fault("offset", receiver, None, 0.0, BIAS_S, metres)]
    for sensor in log.sensors:
        noticeable = (silence_s for silence_s in SILENCES_S if silence_s > MISSED * sensor.period_s)
        yield from (Fault("missing", sensor.name, None, 0.0, silence_s, silence_s) for silence_s in noticeable)


def _batches(wanted: Sequence[Fault], room_s: float) -> Iterator[list[Fault]]:
    """Batches of as many faults as fit into the log, in random order."""
    batch: list[Fault] = []
    for i in np.random.default_rng(0).permutation(len(wanted)):
        needed = sum(fault.duration_s + PAUSE_S for fault in [*batch, wanted[i]]) + 2 * PAUSE_S
        if batch and needed > room_s:
            yield batch
            batch = []
        batch.append(wanted[i])
    if batch:
        yield batch


def _parts(fault: Fault, log: Log, seed: int) -> list[Fault]:
    """An offset of the whole receiver is an offset of its position in one direction, in latitude and longitude."""
    if fault.channel is not None or fault.kind == "missing":
        return [fault]
    latitude = float(np.nanmedian(log.value[:, log.index("latitude")]))
    way = np.random.default_rng([seed, round(1000 * fault.start_s)]).uniform(0, 2 * np.pi)
    north = fault.magnitude * np.cos(way) / float(meridian_radius(latitude))
    east = fault.magnitude * np.sin(way) / float(transverse_radius(latitude) * np.cos(latitude))
    size = {name: float(from_si(x, "deg")) for name, x in (("latitude", north), ("longitude", east))}
    return [replace(fault, channel=name, magnitude=x) for name, x in size.items()]


def _rows(drive: _Drive, cell: Cell, seeds: int) -> Iterator[Row]:
    """Recall with correct isolation, delay and kind, and the probability of an alarm by chance."""
    size = cell.magnitude if cell.kind != "frozen" else JAM_S
    measured = {
        "detection_rate": cell.recall * cell.sensor_right if cell.recall else 0.0,
        "chance": cell.chance,
        "delay_s": cell.delay_p50_s,
        "kind_right": cell.kind_right,
    }
    for metric, value in measured.items():
        condition = f"{cell.channel} n{cell.faults}"
        yield Row("A4", drive.name, "injected", condition, METHOD, cell.kind, size, metric, value, None, seeds)


def _remarks(rows: Sequence[Row]) -> tuple[str, ...]:
    """The smallest offset on each sensor that is detected in nine of ten cases, as one sentence for each drive."""
    rates = [row for row in rows if row.fault == "offset" and row.metric == "detection_rate"]
    return tuple(
        f"A4, {name}: smallest tested offset that is detected and isolated correctly in nine of ten cases: "
        + ", ".join(_least(where, [row for row in rates if row.data == name]) for where in _places(rates, name))
        + "."
        for name in dict.fromkeys(row.data for row in rows)
    )


def _places(rates: Sequence[Row], name: str) -> list[str]:
    return list(dict.fromkeys(row.condition.split()[0] for row in rates if row.data == name))


def _least(where: str, rates: Sequence[Row]) -> str:
    sizes = [row.magnitude or 0.0 for row in rates if row.condition.split()[0] == where and row.value >= DETECTABLE]
    unit = "sigmas" if "." in where else "m of position"
    return f"{where} {min(sizes):g} {unit}" if sizes else f"{where} none"
