"""Generalised likelihood ratio of a ramp that began somewhere in a window."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.blocks import Window

LEAST = 3  # slots after the onset, or a single wild value is a ramp


class RampGlr(eqx.Module):
    """√ of twice the largest log likelihood ratio: a level with a ramp from its onset j on, against the level alone.

    Willsky & Jones 1976, their statistic for a ramp, over every onset in the window; level and rate are estimated too.
    White noise of variance S is presumed, so that for one onset the score would be |normal|; healthy differences of two
    sensors are not white, which is why its limit is learned. Sums from the newest back make it one pass.
    """

    def __call__(self, seen: Window) -> Float[Array, " C"]:
        w = seen.weight
        total = jnp.maximum(w.sum(axis=0), 1e-300)
        y = seen.value - ((w * seen.value).sum(axis=0) / total)[None]
        t = -seen.age
        # of the slots from j on: Σw, Σwt, Σwt², Σwy, Σwty
        w0, w1, w2, y0, y1 = (_after(x) for x in (w, w * t, w * t**2, w * y, w * t * y))
        # z_i = max(t_i - t_j, 0):  Σwz = Σwt - t_j Σw,  Σwz² = Σwt² - 2 t_j Σwt + t_j² Σw,  Σwzy = Σwty - t_j Σwy
        mean = w1 - t * w0
        spread = w2 - 2 * t * w1 + t**2 * w0 - mean**2 / total[None]
        pull = y1 - t * y0
        # the slots are ordered, and an onset in an empty one explains nothing
        fit = (w > 0) & (_after((w > 0).astype(w.dtype)) > LEAST) & (spread > 1e-9 * jnp.maximum(w2, 1e-300))
        # 2 ln Λ_j = (Σ w z y)² / Σ w (z - z̄)²
        ratio = jnp.where(fit, pull**2 / jnp.where(fit, spread, 1.0), 0.0)
        return jnp.sqrt(ratio.max(axis=0))


def _after(x: Float[Array, "K C"]) -> Float[Array, "K C"]:
    """Sums from each slot to the newest."""
    return jnp.flip(jnp.cumsum(jnp.flip(x, axis=0), axis=0), axis=0)
