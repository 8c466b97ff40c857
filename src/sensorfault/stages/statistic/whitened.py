"""Whitened innovation of each sensor: its largest component, or its length."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Score, Trust


class Whitened(eqx.Module):
    """One test a group of channels (a sensor): w = L⁻¹ e with S = L L', S the group's part of `residual.cov`.

    The score is the largest |w_i|, or with `joint` the length of w, Mahalanobis' distance: that does not depend on the
    order of the channels, so it is the one to take for a position. Min et al. 2021, equation (23), leaves the norm
    open. Channels that are not valid are left out. All valid channels of a group are blamed alike: what is wrong with
    a position is seldom wrong with its latitude alone.
    """

    groups: tuple[tuple[int, ...], ...] = eqx.field(static=True)
    channels: int = eqx.field(static=True)
    joint: bool = eqx.field(static=True, default=True)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        values, valid, covers = [], [], []
        for group in self.groups:
            there = jnp.stack([residual.valid[c] for c in group])
            w = jnp.abs(_whitened(residual, group, there))
            largest = jnp.maximum(w.max(), 1e-300)  # taken out before squaring, against overflow
            values.append(largest * jnp.sqrt(((w / largest) ** 2).sum()) if self.joint else w.max())
            valid.append(there.any())
            mine = [(jnp.arange(self.channels) == c) & there[i] for i, c in enumerate(group)]
            covers.append(jnp.stack(mine).any(axis=0))
        examined = jnp.stack(covers)
        return Score(jnp.stack(values), jnp.stack(valid), examined, examined.astype(float)), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


def _whitened(residual: Residual, group: tuple[int, ...], there: Bool[Array, " G"]) -> Float[Array, " G"]:
    """L⁻¹ e row by row; a component that is not there is zero and touches no other."""
    sigma = [jnp.sqrt(residual.cov[c, c]) for c in group]
    lower: list[list[Float[Array, ""]]] = []
    w: list[Float[Array, ""]] = []
    for i, c in enumerate(group):
        # L_ij = (S_ij - Σ_k L_ik L_jk) / L_jj,  L_ii = √(S_ii - Σ_k L_ik²)
        row: list[Float[Array, ""]] = []
        for j in range(i):
            s = jnp.where(there[i] & there[j], residual.cov[c, group[j]] / (sigma[i] * sigma[j]), 0.0)
            row.append((s - sum(row[k] * lower[j][k] for k in range(j))) / lower[j][j])
        row.append(jnp.sqrt(jnp.maximum(1.0 - sum(x**2 for x in row), 1e-12)))
        lower.append(row)
        # w_i = (e_i - Σ_k L_ik w_k) / L_ii
        e = jnp.where(there[i], residual.value[c] / sigma[i], 0.0)
        own = (e - sum(row[k] * w[k] for k in range(i))) / row[i]
        w.append(jnp.where(there[i], own, 0.0))
    return jnp.stack(w)
