"""The kinematic bicycle model of a car."""

import jax.numpy as jnp
from jaxtyping import Array, Float


def ground_velocity(first: Float[Array, ""], second: Float[Array, ""], polar: bool) -> Float[Array, "2"]:
    """East and north velocity [m/s] from speed and course, or from north and east."""
    if polar:
        return first * jnp.stack([jnp.sin(second), jnp.cos(second)])
    return jnp.stack([second, first])


def bicycle(
    state: Float[Array, "4"], acceleration: Float[Array, ""], curvature: Float[Array, ""], dt: Float[Array, ""]
) -> Float[Array, "4"]:
    """One step of the kinematic bicycle: [x, y, heading φ, speed v] [m, m, rad, m/s].

    Min et al. 2021, equation (16), and (17) in additive form (its matrix form divides by x). `curvature` is
    tan(front wheel angle) / wheelbase [1/m], or yaw rate / speed; φ is positive from x to y.
    """
    x, y, phi, v = state
    # (16) x⁺ = x + Δt v cos φ,  y⁺ = y + Δt v sin φ,  φ⁺ = φ + Δt v tan(δ) / l,  v⁺ = v + Δt a
    return jnp.stack(
        [x + dt * v * jnp.cos(phi), y + dt * v * jnp.sin(phi), phi + dt * v * curvature, v + dt * acceleration]
    )
