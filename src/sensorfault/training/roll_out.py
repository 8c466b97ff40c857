"""The error of a roll-out of the height on a log."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from sensorfault.training.fixes import Fixes
from sensorfault.vehicles.height import Climb, StepNetwork

WINDOWS = 512  # evenly spaced windows for each number of steps


def errors(model: Climb | StepNetwork, fixes: Fixes, steps: Sequence[int]) -> Float[np.ndarray, "M W"]:
    """Measured minus predicted height over each of these numbers of steps [m], in WINDOWS windows without a gap.

    If there are fewer windows (at least one), some are used more than once. Each starts from a measured height. The
    error contains that of the model, of the inputs, and of the height at both ends.
    """
    first = [fixes.windows(n) for n in steps]
    start = [w[np.linspace(0, len(w) - 1, WINDOWS).round().astype(int)] for w in first]
    end = np.stack([s + n for s, n in zip(start, steps, strict=True)])
    # one shape for all, so one compilation: rows before the start are not used
    at = np.maximum(end[..., None] - np.arange(max(steps), -1, -1), 0)
    rolled = _rolled(model, *(jnp.asarray(x[at]) for x in (fixes.height, fixes.inputs, fixes.time)), jnp.asarray(steps))
    return np.asarray(fixes.height[end] - np.asarray(rolled))


@jax.jit
def _rolled(
    model: Climb | StepNetwork,
    height: Float[Array, "M W P"],
    inputs: Float[Array, "M W P U"],
    time: Float[Array, "M W P"],
    steps: Int[Array, " M"],
) -> Float[Array, "M W"]:
    def one(h: Array, x: Array, t: Array, n: Array) -> Array:
        return model.rolled(h[:-1], x, t, n[None])[0]

    return jax.vmap(lambda h, x, t, n: jax.vmap(lambda h, x, t: one(h, x, t, n))(h, x, t))(height, inputs, time, steps)
