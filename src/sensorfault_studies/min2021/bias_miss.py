"""Experiment A4: offsets and silences in a whole car, watched by one recipe under one promise; beside them spikes and
frozen channels of the inertial unit (frozen positions are experiment A2).
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
from sensorfault.logs.table import Log
from sensorfault.logs.units import from_si
from sensorfault.methods.catalog import recipe
from sensorfault.numerics.geodesy import meridian_radius, transverse_radius
from sensorfault.numerics.poisson import rate_below
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import MISSED, Model
from sensorfault.runtime.result import Detection
from sensorfault.training.session import Session
from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings, Row

DRIVES = {"dresden_50hz": "road/dresden_50hz", "drive0708": "road/gnss_imu_drive0708"}
METHOD = "car"
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
    """Recall, delay and naming by kind, channel and size, on the last 40 % of both real drives."""
    rows: list[Row] = []
    for n, (name, folder) in enumerate(DRIVES.items()):

        def tell(share: float, name: str = name, n: int = n) -> None:
            effort.tell(f"A4 {name}", (n + share) / len(DRIVES))

        tell(0.0)
        log = read(real(folder))
        cut = float(log.time[0]) + LEARN * log.duration_s
        model = recipe(METHOD).build(log.between(end_s=cut), 0, Session())
        rest = log.between(cut)
        drive = _Drive(name, model, rest, detect(model, rest))
        rows += _clean(drive)
        cells = tabulate(_outcomes(drive, effort, tell), drive.clean)
        rows += [row for cell in cells for row in _rows(drive, cell, effort.seeds)]
    return Findings(tuple(rows), (), _remarks(rows))


def _clean(drive: _Drive) -> Iterator[Row]:
    """False alarms where nothing was injected, an hour, with the bound that so short a time allows."""
    alarms, hours = len(drive.clean.events), drive.rest.duration_s / 3600
    for condition, value in (("per-hour", alarms / hours), ("per-hour bound95", rate_below(alarms, hours))):
        yield Row("A4", drive.name, "real", condition, METHOD, None, None, "far", value)


def _outcomes(drive: _Drive, effort: Effort, tell: Callable[[float], None]) -> list[Outcome]:
    """Each fault struck in a copy of the rest, several in one copy where there is room between them."""
    result: list[Outcome] = []
    wanted = [one for _ in range(1 if effort.quick else effort.seeds) for one in _wanted(drive.rest, effort.quick)]
    batches = list(_batches(wanted, drive.rest.duration_s))
    for seed, batch in enumerate(batches):
        faults = plan(drive.rest, batch, pause_s=PAUSE_S, seed=seed)
        struck = [part for fault in faults for part in _parts(fault, drive.rest, seed)]
        found = detect(drive.model, inject(drive.rest, struck, seed).log)
        result += judge(found, faults).outcomes
        tell((seed + 1) / len(batches))
    return result


def _wanted(log: Log, quick: bool) -> Iterator[Fault]:
    """One of each; of those on the position, whose direction is drawn by lot, four."""
    for channel in (c for c in log.channels if c.name in ("x", "y", "z")):
        for size in SIGMAS[-1:] if quick else SIGMAS:
            yield Fault("offset", channel.sensor, channel.name, 0.0, BIAS_S, size, sigmas=True)
        yield Fault("frozen", channel.sensor, channel.name, 0.0, JAM_S)
        yield Fault("spike", channel.sensor, channel.name, 0.0, 0.0, SPIKE_SIGMAS, sigmas=True)
    receiver = log.channels[log.index("latitude")].sensor
    for metres in METRES[-1:] if quick else METRES:
        yield from 4 * [Fault("offset", receiver, None, 0.0, BIAS_S, metres)]
    for sensor in log.sensors:
        received = (silence_s for silence_s in SILENCES_S if silence_s > MISSED * sensor.period_s)
        yield from (Fault("missing", sensor.name, None, 0.0, silence_s, silence_s) for silence_s in received)


def _batches(wanted: Sequence[Fault], room_s: float) -> Iterator[list[Fault]]:
    """As many faults at once as the log has room for, in shuffled order."""
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
    """An offset of the whole receiver is one of its position: latitude and longitude, so many metres one way."""
    if fault.channel is not None or fault.kind == "missing":
        return [fault]
    latitude = float(np.nanmedian(log.value[:, log.index("latitude")]))
    way = np.random.default_rng([seed, round(1000 * fault.start_s)]).uniform(0, 2 * np.pi)
    north = fault.magnitude * np.cos(way) / float(meridian_radius(latitude))
    east = fault.magnitude * np.sin(way) / float(transverse_radius(latitude) * np.cos(latitude))
    size = {name: float(from_si(x, "deg")) for name, x in (("latitude", north), ("longitude", east))}
    return [replace(fault, channel=name, magnitude=x) for name, x in size.items()]


def _rows(drive: _Drive, cell: Cell, seeds: int) -> Iterator[Row]:
    """Recall of the right sensor, delay and naming, beside what chance finds."""
    size = cell.magnitude if cell.kind != "frozen" else JAM_S
    result = {
        "detection_rate": cell.recall * cell.sensor_right if cell.recall else 0.0,
        "chance": cell.chance,
        "delay_s": cell.delay_p50_s,
        "kind_right": cell.kind_right,
    }
    for metric, value in result.items():
        condition = f"{cell.channel} n{cell.faults}"
        yield Row("A4", drive.name, "injected", condition, METHOD, cell.kind, size, metric, value, None, seeds)


def _remarks(rows: Sequence[Row]) -> tuple[str, ...]:
    """The smallest offset on each sensor that is found in nine of ten, as one sentence a drive."""
    rates = [row for row in rows if row.fault == "offset" and row.metric == "detection_rate"]
    return tuple(
        f"A4, {name}: smallest offset of those tried that is found and laid to the right sensor in nine of ten: "
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
