"""Noise of dead reckoning and ranges, by maximum likelihood of the innovations of a healthy log."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Report, Sample
from sensorfault.logs.table import Log
from sensorfault.runtime.runners import replay, samples

HEAVY = 4.0  # degrees of freedom of Student's t distribution for the innovations: outliers hardly count
NARROW = 0.8310  # scale s of this distribution fitted to N(0, 1): E (ν + 1) z² / (ν + z²) = 1 for z = N(0, 1) / s
IGNORED = 100.0  # a range whose noise is larger than so many times its variance is ignored
START = (0.1, 3.0)  # [m²/s], [m]
ROUND = 256  # the number of rows is rounded up to a multiple of this
BOUNDS = ((1e-4, 10.0), (0.01, 50.0))


def likeliest(build: Callable[[Float[Array, ""], Float[Array, ""]], Monitor], log: Log) -> tuple[float, float]:
    """Variance that a second of dead reckoning adds [m²/s] and standard deviation of a range [m].

    `build(q, sigma)` gives a monitor with its limits off. The likelihood is that of Student's t distribution, so that
    outliers hardly count.
    """
    from scipy.optimize import minimize  # lazily: slow to import, and seldom needed

    rows = _filled(log)

    def at(x: Float[np.ndarray, "2"]) -> float:
        return float(_cost(build(*jnp.exp(jnp.asarray(x))), rows))

    options = {"xatol": 0.03, "fatol": 0.1}
    found = minimize(at, np.log(START), method="Nelder-Mead", bounds=np.log(BOUNDS), options=options)
    q, sigma = np.exp(found.x) / np.array([NARROW**2, NARROW])
    return float(q), float(sigma)


def _filled(log: Log) -> Sample:
    """The log, filled up with empty rows to a multiple of ROUND, so that one compilation serves many logs."""
    after = (0, -len(log) % ROUND)
    value = np.pad(log.value, (after, (0, 0)), constant_values=np.nan)
    return samples(np.pad(log.time, after, "edge"), value, np.pad(log.fresh, (after, (0, 0))))


@jax.jit
def _cost(monitor: Monitor, rows: Sample) -> Float[Array, ""]:
    return replay(monitor, monitor.init(), rows, _loss)[1].sum()


def _loss(report: Report) -> Float[Array, ""]:
    residual = report.residual
    s = jnp.diagonal(residual.cov)
    # -2 log p = log S + (ν + 1) log(1 + r² / ν S)
    loss = jnp.log(s) + (HEAVY + 1) * jnp.log1p(residual.value**2 / (HEAVY * s))
    informative = residual.valid & (residual.noise < IGNORED * s)  # an exact repeat has no weight
    return jnp.where(informative, loss, 0.0).sum()
