"""How noisy dead reckoning and ranges are: what makes the innovations of a healthy log likeliest."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.logs.table import Log
from sensorfault.monitor.monitor import Monitor
from sensorfault.run import replay, samples
from sensorfault.types import Report, Sample

WILD = 3.0  # an innovation counts no more than one of so many standard deviations (Huber 1964)
START = (0.1, 3.0)  # [m²/s], [m]
BOUNDS = ((1e-4, 10.0), (0.01, 50.0))


def likeliest(build: Callable[[Float[Array, ""], Float[Array, ""]], Monitor], log: Log) -> tuple[float, float]:
    """Variance that a second of dead reckoning adds [m²/s] and standard deviation of a range [m].

    `build(q, sigma)` gives a monitor whose limits are off. The likelihood is that of Gaussian innovations, robust to a
    few wild ones.
    """
    from scipy.optimize import minimize  # lazily: slow to import, and seldom needed

    rows = samples(log.time, log.value, log.fresh)
    cost = jax.jit(lambda q, sigma: _cost(build(q, sigma), rows))

    def at(x: Float[np.ndarray, "2"]) -> float:
        return float(cost(*jnp.exp(jnp.asarray(x))))

    options = {"xatol": 0.03, "fatol": 0.1}
    found = minimize(at, np.log(START), method="Nelder-Mead", bounds=np.log(BOUNDS), options=options)
    q, sigma = np.exp(found.x)
    return float(q), float(sigma)


def _cost(monitor: Monitor, rows: Sample) -> Float[Array, ""]:
    return replay(monitor, monitor.init(), rows, _loss)[1].sum()


def _loss(report: Report) -> Float[Array, ""]:
    residual = report.residual
    s = jnp.diagonal(residual.cov)
    size = jnp.abs(residual.value) / jnp.sqrt(s)
    # -2 log p = log S + ρ(r / √S),  ρ(z) = z² up to WILD and a straight line beyond
    loss = jnp.log(s) + jnp.where(size < WILD, size**2, WILD * (2 * size - WILD))
    told = residual.valid & (residual.noise <= s)  # an exact repeat, which weighs less, says nothing of the noise
    return jnp.where(told, loss, 0.0).sum()
