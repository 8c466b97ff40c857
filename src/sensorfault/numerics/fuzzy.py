"""Fuzzy inference: firing strength of each rule, and the combined output. NumPy or JAX, as the features are."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from sensorfault.numerics.unit_range import UnitRange

FAINT = 1e-30  # squared distances from a center and triangular memberships are at least this


def bell(t: Float[Any, "*s"], slope: Float[Any, "*p"]) -> Float[Any, "*s"]:
    """Generalised bell."""
    xp = t.__array_namespace__()
    # ln μ = -ln(1 + |t|^2b)
    return -xp.logaddexp(xp.zeros_like(t), slope * xp.log(xp.maximum(t * t, FAINT)))


def gaussian(t: Float[Any, "*s"], slope: Float[Any, "*p"]) -> Float[Any, "*s"]:
    """Gaussian, without a slope."""
    # ln μ = -t²/2
    return -t * t / 2


def triangle(t: Float[Any, "*s"], slope: Float[Any, "*p"]) -> Float[Any, "*s"]:
    """Triangle, without a slope. It keeps falling beyond its feet, so that where no rule fires the nearest one does."""
    xp = t.__array_namespace__()
    away = xp.abs(t)
    # ln μ = ln(1 - |t|)
    return xp.log(xp.maximum(1 - away, FAINT)) - xp.maximum(away - 1, 0.0)


# Logarithms of memberships of t = (x - c) / a: their products are sums, and no rule's strength underflows.
MEMBERSHIPS: dict[str, Callable[[Any, Any], Any]] = {"bell": bell, "gaussian": gaussian, "triangle": triangle}


class Premises(eqx.Module):
    """P membership functions, and R rules that each use one membership of every input.

    `inputs[p]`: the input that membership p looks at. `rules[r]`: the memberships that rule r asks for.
    """

    center: Float[Any, " P"]  # c
    width: Float[Any, " P"]  # a > 0
    slope: Float[Any, " P"]  # b > 0
    inputs: tuple[int, ...] = eqx.field(static=True)
    rules: tuple[tuple[int, ...], ...] = eqx.field(static=True)
    kind: str = eqx.field(static=True, default="bell")

    def grades(self, x: Float[Any, "*batch F"]) -> Float[Any, "*batch P"]:
        """ln μ of each membership. Xu et al. 2023, equation (21)."""
        seen = x.__array_namespace__().stack([x[..., i] for i in self.inputs], axis=-1)
        return MEMBERSHIPS[self.kind]((seen - self.center) / self.width, self.slope)

    def asked(self) -> Float[np.ndarray, "R P"]:
        """1 where a rule uses a membership, else 0."""
        return np.array([[float(p in rule) for p in range(len(self.inputs))] for rule in self.rules])


def strengths(fired: Float[Any, "*batch R"]) -> Float[Any, "*batch R"]:
    """Normalised firing strengths from ln w; the strongest never underflows, so they sum to 1."""
    xp = fired.__array_namespace__()
    w = xp.exp(fired - fired.max(axis=-1, keepdims=True))
    # (23) w_i / Σ w
    return w / w.sum(axis=-1, keepdims=True)


class Anfis(eqx.Module):
    """First-order Takagi-Sugeno inference, Xu et al. 2023, equations (21)-(25), of features in their own units.

    `consequents[r]`: D = F + 1 numbers: what rule r says by each scaled feature, then its constant.
    """

    unit: UnitRange
    premises: Premises
    consequents: Float[Any, "R D"]

    def __call__(self, features: Float[Any, "*batch F"]) -> Float[Any, "*batch"]:
        x = self.unit(features)
        # (22) ln w_i = Σ ln μ. A sum, since a matrix product of this size would break the loop around it in two.
        fired = (self.premises.grades(x)[..., None, :] * self.premises.asked()).sum(axis=-1)
        # (24) f_i = m_i x + .. + r_i
        says = (x[..., None, :] * self.consequents[:, :-1]).sum(axis=-1) + self.consequents[:, -1]
        # (25)
        return (strengths(fired) * says).sum(axis=-1)
