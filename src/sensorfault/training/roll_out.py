"""How far a roll-out of the height errs on a log."""

import sensorfault._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.training.fixes import Fixes
from sensorfault.vehicles.height import Climb, StepNetwork


def errors(model: Climb | StepNetwork, fixes: Fixes, steps: int, most: int = 300) -> Float[np.ndarray, " W"]:
    """Measured minus rolled out over so many steps [m], of unbroken windows; each starts from what was measured.

    Whoever it is that errs: the model, the inputs, or the height at either end. Of more than `most` windows, so many
    that lie evenly.
    """
    first = fixes.windows(steps)
    first = first[np.linspace(0, len(first) - 1, min(len(first), most)).round().astype(int)]
    at = first[:, None] + np.arange(steps + 1)
    rolled = _rolled(model, *(jnp.asarray(x[at]) for x in (fixes.height, fixes.inputs, fixes.time)))
    return np.asarray(fixes.height[at[:, -1]] - np.asarray(rolled))


@jax.jit
def _rolled(
    model: Climb | StepNetwork, height: Float[Array, "W P"], inputs: Float[Array, "W P U"], time: Float[Array, "W P"]
) -> Float[Array, " W"]:
    steps = jnp.asarray([height.shape[1] - 1])
    return jax.vmap(lambda h, x, t: model.rolled(h[:-1], x, t, steps)[0])(height, inputs, time)
