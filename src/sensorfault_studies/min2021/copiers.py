"""The methods that A1 compares on spikes, fitted on the healthy part of a drive, with the time of the fit."""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from jaxtyping import Float

from sensorfault.calibration.scaling import Scaling
from sensorfault.logs.table import Log
from sensorfault.methods.catalog import recipe
from sensorfault.methods.inertial.reconstructed import reconstructed
from sensorfault.runtime.model import Model
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.training.backprop import Start, fit_backprop, untrained, usual
from sensorfault.training.cross_validation import Fit
from sensorfault.training.elm import fit_elm
from sensorfault.training.gradient import Plan
from sensorfault.training.session import Session

Build = Callable[[Log, int], tuple[Model, float]]

# The usual backpropagation: Adam at its default rate, until the error on validation rows stops falling.
PLAN = Plan(epochs=300, batch=32, rate=1e-3, patience=30)
QUICK = Plan(epochs=30, batch=32, rate=1e-3, patience=30)


@dataclass(frozen=True)
class Candidate:
    """A method to compare. `build(log, seed)` gives the model and the time of its fit [s].

    `limit`: how its limit is set. `chance`: whether the seed matters. `main`: shown in every table, not only for AUC.
    """

    method: str
    condition: str
    build: Build
    limit: str = "as-printed"
    chance: bool = True
    main: bool = True


def candidates(quick: bool) -> tuple[Candidate, ...]:
    """The paper's two networks, two baselines, and the networks with too few units or a ridge too strong to copy."""
    main = (
        Candidate("elm-autoencoder", "L32 C1e3", _elm(32, 1e3)),
        Candidate("bp-autoencoder", "L32", _backprop(32, QUICK if quick else PLAN)),
        Candidate("pca", "components3", _plain("pca"), chance=False),
        Candidate("linear-conditioning", "lags4", _plain("linear-conditioning"), "cross-validated", chance=False),
    )
    if quick:
        return main
    return (
        *main,
        Candidate("elm-autoencoder", "L3 C1e3", _elm(3, 1e3), main=False),
        Candidate("elm-autoencoder", "L32 C0.01", _elm(32, 0.01), main=False),
        Candidate("bp-autoencoder", "L32 elm-start", _backprop(32, PLAN, untrained), main=False),
        Candidate("bp-autoencoder", "L3", _backprop(3, PLAN), main=False),
    )


def _elm(hidden: int, c: float) -> Build:
    # A fit of milliseconds ends before the processor reaches full speed: the fastest of ten counts.
    return _timed("elm-autoencoder", lambda seed: lambda rows, scaling: fit_elm(rows, scaling, hidden, c, seed), 10)


def _backprop(hidden: int, plan: Plan, start: Start = usual) -> Build:
    return _timed(
        "bp-autoencoder",
        lambda seed: lambda rows, scaling: fit_backprop(rows, scaling, hidden, plan, seed, start=start),
    )


def _timed(name: str, seeded: Callable[[int], Fit], times: int = 1) -> Build:
    def build(log: Log, seed: int) -> tuple[Model, float]:
        took: list[float] = []
        fit = seeded(seed)

        def clocked(rows: Float[np.ndarray, "N C"], scaling: Scaling) -> Reconstruction:
            for _ in range(times):
                start = perf_counter()
                found = fit(rows, scaling)
                took.append(perf_counter() - start)
            return found

        return reconstructed(name, log, clocked), min(took)

    return build


def _plain(name: str) -> Build:
    def build(log: Log, seed: int) -> tuple[Model, float]:
        start = perf_counter()
        return recipe(name).build(log, seed, Session()), perf_counter() - start

    return build
