"""Experiment C, condition (c): signals out of sight, found and left out, by labels; where the car was, by its truth."""

from collections.abc import Iterator
from dataclasses import dataclass

import sensorfault._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.evaluation.ranking import auc
from sensorfault.logs.epochs import framing
from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.drop import Drop
from sensorfault.monitor.residual.ins_gnss import InsGnss
from sensorfault.monitor.statistic.late import Late
from sensorfault.monitor.statistic.normalised import Normalised
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.numerics.gnss import sight
from sensorfault.studies.findings import Effort, Findings
from sensorfault.studies.numbers import Numbers
from sensorfault.studies.wang2023.navigated import Navigated, horizontal, navigated
from sensorfault.studies.wang2023.smartloc import Town, town
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise, Grade

NONE = "no-exclusion"
UNSCORED = 25  # epochs until a filter has begun
LOST_M = 1e3
MOST = 12  # satellites taken out at one epoch
ONE_SIDED, TWO_SIDED = 2.33, 2.58  # where a normal number is once in a hundred

# Turn rate by what it says at rest, speed by its steps of 0.03 m/s and slipping, forces by slopes nobody measures
# (0.1 m/s/√s), the clock as a TCXO's; none of it is fitted to the truth.
GRADE = Grade(*(jnp.asarray(x) for x in (0.002, 0.1, 1e-4, 1e-3, 0.1, 0.19, 0.01, 0.2, 1.5)))
WHEEL_M_S, ASIDE_M_S = 0.1, 0.1
# σ² = a + b 10^(-C/N0 / 10): b as of heavily degraded signals (10⁶ m² Hz), a as of slightly degraded ones (10 m²).
# Source: H. Kuusniemi, User-level reliability and quality monitoring in satellite-based personal navigation (2005).
CARRIER = CarrierNoise(jnp.sqrt(jnp.asarray(10.0)), jnp.asarray(1e6))
OPEN_SKY = ElevationNoise(*(jnp.asarray(x) for x in (1.4, 4.0, np.deg2rad(15.0), 1.0)))


@dataclass(frozen=True)
class Way:
    """How satellites are weighed and judged: whether by C/N0, which side counts, and from where on."""

    condition: str
    method: str
    carrier: bool
    late: bool
    limit: float


WAYS = (
    Way("open-sky", NONE, False, False, np.inf),
    Way("open-sky", "innovation-chi-square", False, False, TWO_SIDED),
    Way("carrier", NONE, True, True, np.inf),
    Way("carrier", "innovation-chi-square", True, False, TWO_SIDED),
    Way("carrier", "late", True, True, ONE_SIDED),
)


def nlos(effort: Effort) -> Findings:
    """Each way with the wheels and without; what C/N0 alone tells, and what a receiver that knew its place could.

    Raises:
        LogError: the real log is not there.
    """
    of = town()
    numbers = Numbers("C", "smartloc", "real")
    for i, wheels in enumerate((True, False)):
        for k, way in enumerate(WAYS):
            effort.tell(f"smartLoc: {way.method}", (i * len(WAYS) + k) / (2 * len(WAYS)))
            words = f"{way.condition} {'wheels' if wheels else 'bare'}"
            numbers.add(words, way.method, scores(of, through(of, way, wheels)))
    for words, score in (("cn0-alone", -of.cn0), ("known-place", _known_place(of))):
        for which, value in _ranked(of, score, np.isfinite(score)).items():
            numbers.add(words, NONE, {which: value})
    return Findings(tuple(numbers.rows()), (), tuple(_remarks(numbers, of)))


def through(of: Town, way: Way, wheels: bool) -> Navigated:
    """The drive through the filter, judged in this way."""
    log = of.log if wheels else of.bare
    many = len(of.names)
    residual = InsGnss(
        GRADE,
        CARRIER if way.carrier else OPEN_SKY,
        jnp.asarray(0.1),
        jnp.asarray(WHEEL_M_S),
        jnp.asarray(ASIDE_M_S),
        tuple(int(name[0] != "G") for name in of.names),
        parts=1,
    )
    branch = Branch(Late() if way.late else Normalised(), Fixed(jnp.full(many, way.limit)))
    monitor = Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(many), tuple(range(many)), most=MOST)
    return navigated(monitor, framing(log, of.names, False, "wheel.speed" if wheels else "").frame(log))


def scores(of: Town, run: Navigated) -> dict[str, float]:
    """Position over the whole drive but its start; what was found, where labels are, by innovations in metres."""
    off = horizontal(run.position, of.position)[UNSCORED:]
    tested = run.tested
    known = np.isfinite(of.nlos) & tested
    refused, out = ~run.taken[known], of.nlos[known] == 1
    return {
        "error_p50_m": float(np.quantile(off, 0.5)),
        "error_p95_m": float(np.quantile(off, 0.95)),
        "recall": float(refused[out].mean()),
        "far": float(refused[~out].mean()),
        "rejected_fraction": float(1 - run.taken[tested].mean()),
    } | _ranked(of, run.innovation, tested)


def _ranked(of: Town, score: Float[np.ndarray, "T S"], there: Bool[np.ndarray, "T S"]) -> dict[str, float]:
    """Area under the curve over all labelled satellites, and over GPS alone."""
    known = np.isfinite(of.nlos) & there
    gps = known & np.array([name[0] == "G" for name in of.names])
    return {"auc": auc(score[known], of.nlos[known] == 1), "auc_gps": auc(score[gps], of.nlos[gps] == 1)}


def _known_place(of: Town) -> Float[np.ndarray, "T S"]:
    """How much too long each pseudorange is by the true place and the clock that satellites in sight show [m]."""
    place = np.stack([_column(of, f"{axis}_m") for axis in "xyz"], axis=2)
    left = _column(of, "corrected_m") - np.asarray(sight.distance(of.position[:, None], place))
    straight = np.where((of.nlos == 0) & np.array([name[0] == "G" for name in of.names]), left, np.nan)
    some = np.isfinite(straight).any(axis=1)
    clock = np.full((len(left), 1), np.nan)
    clock[some, 0] = np.nanmedian(straight[some], axis=1)
    late: Float[np.ndarray, "T S"] = left - clock
    return late


def _column(of: Town, name: str) -> Float[np.ndarray, "T S"]:
    return of.bare.value[:, [of.bare.index(f"{one}.{name}") for one in of.names]]


def _remarks(numbers: Numbers, of: Town) -> Iterator[str]:
    """In sentences: what exclusion brings, and how well a detour can be told at all."""
    for wheels in ("wheels", "bare"):
        words = f"carrier {wheels}"
        before, after = ([numbers.mean(words, method, f"error_p{p}_m") for p in (50, 95)] for method in (NONE, "late"))
        yield (
            f"smartLoc, {'with' if wheels == 'wheels' else 'without'} wheels: leaving out what is late takes the "
            f"horizontal error from {before[0]:.1f} to {after[0]:.1f} m (50 %) and from {before[1]:.1f} to "
            f"{after[1]:.1f} m (95 %)."
        )
    known = np.isfinite(of.nlos)
    alone, place, found = (
        "{:.2f} (GPS {:.2f})".format(*(numbers.mean(words, method, metric) for metric in ("auc", "auc_gps")))
        for words, method in (("cn0-alone", NONE), ("known-place", NONE), ("carrier wheels", "late"))
    )
    yield (
        f"smartLoc: {int(known.sum())} labels in the first minute, {np.mean(of.nlos[known]):.0%} out of sight. "
        f"Innovations of the filter with wheels rank them with an AUC of {found}, C/N0 alone with {alone}, residuals "
        f"at the true place with the clock of satellites in sight with {place}: about as well as ranges can tell."
    )
    wild = sorted({row.condition for row in numbers.rows() if row.metric == "error_p95_m" and row.value > LOST_M})
    if wild:
        yield f"smartLoc: a test of both sides with noise as under an open sky loses the car ({', '.join(wild)})."
